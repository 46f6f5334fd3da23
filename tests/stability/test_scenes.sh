#!/bin/bash
# test_scenes.sh - what the scenes that are shown first say of themselves is so: holds_but_open.sh.

. tests/stability/holds_but_open.sh
holds_but_open assets/scenes 60 3

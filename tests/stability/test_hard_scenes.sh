#!/bin/bash
# test_hard_scenes.sh - the hard cases hold, but for those listed as open: holds_but_open.sh.

. tests/stability/holds_but_open.sh
holds_but_open assets/scenes/hard 60

// list.h - THE list: every member of a world, and what a snapshot and the world hash do with it.
//
// Whoever adds a member to struct plumb_world, or to one of the structs in it, adds a row here;
// complete.c does not compile otherwise. Columns of the built-in tables need no row: their own lists
// (world/columns.h) are the rows.
//
//   VALUE(path)                a number: saved and hashed
//   TALLY(path)                a number that changes no motion (when the grids were filed, ...): saved. A
//                              ray that files them early must not change the hash
//   ARRAY(type, buffer, count, hashed, key)
//                              the first `count` elements of a pl_buffer: saved, each up to PL_SAVED_BYTES. `hashed` bytes at the
//                              start of each element are hashed: 0 where padding or addresses are in
//                              it, or where only part decides motion, and hash.c does that part by
//                              hand. `key` bytes at the start name an
//                              element, so that deltas find it where others came or went; 0: its
//                              index does
//   TABLE(path)                a table of columns: saved and hashed, but for columns of pointers and the
//                              fat boxes, which are only saved
//   OWN(path)                  section_own.c saves it by hand
//   LEFT(path)                 neither saved nor hashed: scratch that every step fills before reading,
//                              events of the last step, what follows from the rest (restore.c makes it
//                              anew), what belongs to this process (memory, hooks, timers, errors)
#ifndef PL_STATE_LIST_H
#define PL_STATE_LIST_H

#include "broad/pairs.h"
#include "core/sort.h"
#include "schema/joint.h"
#include "schema/world.h"
#include "world/material_pair.h"
#include "world/state.h"

// clang-format off
#define PL_STATE_DESC(VALUE, TALLY, ARRAY, TABLE, OWN, LEFT)                                       \
    PL_WORLD_ROWS(PL_ROW_STATE, VALUE)                                                            \
    TALLY(desc.no_exact_islands) TALLY(desc.no_fine_islands) LEFT(desc.workers) LEFT(desc.measure) LEFT(desc.watchdog) LEFT(desc.tasks)                                                            \
    LEFT(desc.simd_width) /* of this machine; every width gives the same bits */                   \
    LEFT(desc.body_capacity) LEFT(desc.shape_capacity) LEFT(desc.contact_capacity)                 \
    LEFT(desc.allocator) LEFT(desc.log) LEFT(desc.assert_failed) LEFT(desc.hook_context)           \
    LEFT(desc.user_data)

#define PL_STATE_REGISTRY(VALUE, TALLY, ARRAY, TABLE, OWN, LEFT)                                   \
    OWN(registry.slots) OWN(registry.count) LEFT(registry.bytes) LEFT(registry.capacity)           \
    LEFT(registry.moves) /* what was derived from rows is derived anew */                          \
    VALUE(registry.free_head) VALUE(registry.free_tail) VALUE(registry.live)

#define PL_STATE_PIECES(VALUE, TALLY, ARRAY, TABLE, OWN, LEFT)                                     \
    TABLE(pieces) VALUE(pieces.free_head) VALUE(pieces.live)

#define PL_STATE_VERTICES(VALUE, TALLY, ARRAY, TABLE, OWN, LEFT)                                   \
    OWN(vertices.items) OWN(vertices.count) LEFT(vertices.bytes) LEFT(vertices.capacity)           \
    VALUE(vertices.free_head)

#define PL_STATE_COMMANDS(VALUE, TALLY, ARRAY, TABLE, OWN, LEFT)                                   \
    ARRAY(char, commands.bytes, commands.used, 0, 0) VALUE(commands.count)

// The grids follow from the fat boxes and the list of moving pieces.
#define PL_STATE_BROAD(VALUE, TALLY, ARRAY, TABLE, OWN, LEFT)                                      \
    LEFT(broad.moving) LEFT(broad.fixed) LEFT(broad.resting) LEFT(broad.refreshed)                 \
    LEFT(broad.unfiled) ARRAY(uint32_t, broad.left, broad.left_count, 0, 0) LEFT(broad.left_marks) \
    LEFT(broad.moving_lost) LEFT(broad.fixed_lost) LEFT(broad.resting_lost) TALLY(broad.emptied)   \
    ARRAY(pl_pair, broad.pairs.items, broad.pairs.count, 0, 8)                                     \
    TALLY(broad.pairs.first) TALLY(broad.pairs.size) LEFT(broad.pairs.old_items)                   \
    LEFT(broad.list) LEFT(broad.found) LEFT(broad.sorted) LEFT(broad.counts) LEFT(broad.lost)      \
    LEFT(broad.found_count)                                                                        \
    ARRAY(pl_found, broad.sensed, broad.sensed_count, 0, 0)                                        \
    TALLY(broad.serial) TALLY(broad.rebuilds) TALLY(broad.stale)

#define PL_STATE_NARROW(VALUE, TALLY, ARRAY, TABLE, OWN, LEFT)                                     \
    LEFT(narrow.manifolds) LEFT(narrow.staged) LEFT(narrow.ends) LEFT(narrow.chains) LEFT(narrow.fresh)               \
    LEFT(narrow.fresh_count) LEFT(narrow.candidates) LEFT(narrow.candidate_count) LEFT(narrow.ends_stale) LEFT(narrow.manifold_count) LEFT(narrow.borne_count)                    \
    LEFT(narrow.any_adhesion) LEFT(narrow.any_kinetic) LEFT(narrow.any_friction)                                            \
    LEFT(narrow.any_elastic) LEFT(narrow.any_low) LEFT(narrow.any_surface) LEFT(narrow.overlaps)

#define PL_STATE_SOLVER(VALUE, TALLY, ARRAY, TABLE, OWN, LEFT)                                     \
    LEFT(solver.bodies) LEFT(solver.motions) LEFT(solver.residuals) LEFT(solver.kicked) LEFT(solver.struck)                 \
    LEFT(solver.rows) LEFT(solver.slots) LEFT(solver.masks) LEFT(solver.colors)                    \
    LEFT(solver.lanes) LEFT(solver.bundles) LEFT(solver.extras) LEFT(solver.specials) LEFT(solver.grips)              \
    LEFT(solver.impacts) LEFT(solver.rubbed) LEFT(solver.bounces) LEFT(solver.turnings) LEFT(solver.turning)                     \
    LEFT(solver.impact_heap) LEFT(solver.impact_heads) LEFT(solver.due_count) LEFT(solver.since) LEFT(solver.follows_impacts)   \
    LEFT(solver.classic) LEFT(solver.dynamic_slots) LEFT(solver.slot_count)   \
    LEFT(solver.clusters) LEFT(solver.labels) LEFT(solver.islands) LEFT(solver.homes) LEFT(solver.island_count) LEFT(solver.leaders) LEFT(solver.cursors)                 \
    LEFT(solver.cluster_count) LEFT(solver.cluster_age) LEFT(solver.labelled) LEFT(solver.fine_cluster) LEFT(solver.fine_islands) TALLY(solver.fine_before) LEFT(solver.hard_cluster) LEFT(solver.hard_count) LEFT(solver.hard_islands) TALLY(solver.hard_pressed) TALLY(solver.hard_before) LEFT(solver.hard_contacts) LEFT(solver.apart_leaders) LEFT(solver.apart_tallies) LEFT(solver.bundle_room) LEFT(solver.bundle_count) LEFT(solver.impact_count) LEFT(solver.colors_used)                 \
    LEFT(solver.overflow_count) LEFT(solver.bounce_count) LEFT(solver.chain_count) TALLY(solver.cut_count) LEFT(solver.spare_impacts)

#define PL_STATE_JOINTS(VALUE, TALLY, ARRAY, TABLE, OWN, LEFT)                                     \
    ARRAY(pl_joint, joints.items, joints.count, 0, 0)                                              \
    LEFT(joints.broken) LEFT(joints.broken_count) LEFT(joints.strained_first) LEFT(joints.strained_count) VALUE(joints.live) VALUE(joints.free_head)       \
    VALUE(joints.watched) VALUE(joints.bouncing) LEFT(joints.awake) LEFT(joints.awake_count) LEFT(joints.awake_stale)   \
    LEFT(joints.plan)

#define PL_STATE_PARTS(VALUE, TALLY, ARRAY, TABLE, OWN, LEFT)                                      \
    LEFT(parts.items) LEFT(parts.count) LEFT(parts.lost) LEFT(parts.lost_count) TALLY(parts.buried)

#define PL_STATE_PENDING_HITS(VALUE, TALLY, ARRAY, TABLE, OWN, LEFT)                                      \
    ARRAY(pl_pending_hit, pending_hits.items, pending_hits.count, sizeof(pl_pending_hit), 8)                                   \
    LEFT(pending_hits.old) LEFT(pending_hits.old_count) LEFT(pending_hits.next) LEFT(pending_hits.lost_count) LEFT(pending_hits.late_count)

#define PL_STATE_SENSING(VALUE, TALLY, ARRAY, TABLE, OWN, LEFT)                                    \
    ARRAY(pl_keyed, sensing.candidates, sensing.candidate_count, 0, 8)                             \
    TALLY(sensing.rebuilds)                                                                        \
    ARRAY(pl_overlap, sensing.overlaps, sensing.count, sizeof(pl_overlap), 8)                      \
    ARRAY(pl_keyed, sensing.rest_candidates, sensing.rest_candidate_count, 0, 8)                   \
    ARRAY(pl_overlap, sensing.rest_overlaps, sensing.rest_count, sizeof(pl_overlap), 8)            \
    LEFT(sensing.rest_old) LEFT(sensing.rest_old_count) TALLY(sensing.rest_stale)                  \
    LEFT(sensing.old) LEFT(sensing.old_count) LEFT(sensing.begins) LEFT(sensing.ends)              \
    LEFT(sensing.begin_count) LEFT(sensing.end_count)

// The grid of what sleeps and the list of what moves near it are made anew.
#define PL_STATE_SLEEP(VALUE, TALLY, ARRAY, TABLE, OWN, LEFT)                                      \
    ARRAY(pl_island, sleep.islands, sleep.island_slots, 0, 0)                                      \
    ARRAY(pl_sleeping_contact, sleep.contacts, sleep.contact_slots, 0, 0)                                   \
    VALUE(sleep.island_count) VALUE(sleep.free_island) VALUE(sleep.contact_count)                  \
    VALUE(sleep.free_contact) VALUE(sleep.first_due)                                               \
    ARRAY(uint32_t, sleep.resting, sleep.resting_count, sizeof(uint32_t), 0)                       \
    TALLY(sleep.boxes_stale) TALLY(sleep.grid_stale) LEFT(sleep.gone) VALUE(sleep.placed_pieces)   \
    LEFT(sleep.near) LEFT(sleep.near_stale) LEFT(sleep.probe) LEFT(sleep.found)                    \
    LEFT(sleep.found_count) LEFT(sleep.touched) LEFT(sleep.marked) LEFT(sleep.marked_count)        \
    LEFT(sleep.woken) VALUE(sleep.timed_step) VALUE(sleep.changed_step) VALUE(sleep.tested_step)   \
    VALUE(sleep.since) VALUE(sleep.passed) VALUE(sleep.candidate_in) LEFT(sleep.parents)               \
    LEFT(sleep.held) LEFT(sleep.places) LEFT(sleep.sleep_events) LEFT(sleep.wake_events)           \
    LEFT(sleep.fallen)                                                                             \
    LEFT(sleep.sleep_event_count) LEFT(sleep.wake_event_count) LEFT(sleep.events_told)               \
    LEFT(sleep.lent_step) LEFT(sleep.holds) LEFT(sleep.holds_new) LEFT(sleep.pushed) /* hints */

// Corners and stretches follow from where the ground lies, but not at once: they are kept up.
#define PL_STATE_INTERNAL_EDGES(VALUE, TALLY, ARRAY, TABLE, OWN, LEFT)                                      \
    VALUE(internal_edges.count) TALLY(internal_edges.dirty) TALLY(internal_edges.all) TALLY(internal_edges.relist)  \
    ARRAY(pl_edge, internal_edges.corners, internal_edges.corner_count, 0, 0)                                        \
    ARRAY(pl_interval, internal_edges.intervals, internal_edges.interval_used, 0, 0) TALLY(internal_edges.interval_free)                      \
    ARRAY(pl_box, internal_edges.regions, internal_edges.region_count, 0, 0)                                         \
    LEFT(internal_edges.chosen) LEFT(internal_edges.chosen_count) LEFT(internal_edges.around) LEFT(internal_edges.around_count)        \
    LEFT(internal_edges.scratch) ARRAY(pl_edge_pair, internal_edges.pairs, internal_edges.pair_count, 0, 0)                   \
    LEFT(internal_edges.contacts) LEFT(internal_edges.contact_count) LEFT(internal_edges.runs) LEFT(internal_edges.order)              \
    ARRAY(pl_run_load, internal_edges.loads, internal_edges.load_count, 0, 0)                                        \
    LEFT(internal_edges.old_loads) LEFT(internal_edges.old_load_count) LEFT(internal_edges.slots) LEFT(internal_edges.slot_count)      \
    LEFT(internal_edges.borne) LEFT(internal_edges.apart) LEFT(internal_edges.noted) LEFT(internal_edges.opened) TALLY(internal_edges.listed) TALLY(internal_edges.updated)

#define PL_STATE_CHARACTERS(VALUE, TALLY, ARRAY, TABLE, OWN, LEFT)                                 \
    ARRAY(pl_character, characters.items, characters.count, 0, 8) LEFT(characters.saved)           \
    VALUE(characters.turn) LEFT(characters.moved) LEFT(characters.walks) LEFT(characters.treads)   \
    LEFT(characters.farthest) LEFT(characters.obstacles) LEFT(characters.near) LEFT(characters.pushes)                       \
    LEFT(characters.push_count)

#define PL_STATE_LIQUID(VALUE, TALLY, ARRAY, TABLE, OWN, LEFT)                                      \
    ARRAY(plumb_liquid_desc, liquid.settings, liquid.settings_count, sizeof(plumb_liquid_desc), 0)     \
    ARRAY(plumb_particle, liquid.particles, liquid.count, sizeof(plumb_particle), 0)                 \
    ARRAY(plumb_liquid_phase, liquid.phases, liquid.phase_count, sizeof(plumb_liquid_phase), 0)        \
    ARRAY(pl_liquid_support, liquid.supports.items, liquid.supports.count, sizeof(pl_liquid_support), 8)      \
    LEFT(liquid.scratch) LEFT(liquid.contacts) LEFT(liquid.ends) LEFT(liquid.contact_count)        \
    LEFT(liquid.end_count) LEFT(liquid.index)

#define PL_STATE_AIR(VALUE, TALLY, ARRAY, TABLE, OWN, LEFT)                                        \
    ARRAY(plumb_air_desc, air.settings, air.settings_count, sizeof(plumb_air_desc), 0)             \
    ARRAY(plumb_air_cell, air.cells, air.cell_count, sizeof(plumb_air_cell), 0)                    \
    ARRAY(plumb_air_source, air.sources, air.source_count, sizeof(plumb_air_source), 0)            \
    ARRAY(pl_liquid_support, air.supports.items, air.supports.count, sizeof(pl_liquid_support), 8)  \
    LEFT(air.scratch)
#define PL_STATE_SOFTBODIES(VALUE, TALLY, ARRAY, TABLE, OWN, LEFT)                                 \
    ARRAY(pl_softbody, softbodies.items, softbodies.count, sizeof(pl_softbody), 8)                 \
    ARRAY(plumb_softbody_node, softbodies.nodes, softbodies.node_count,                            \
          sizeof(plumb_softbody_node), 0)                                                          \
    ARRAY(plumb_softbody_edge, softbodies.edges, softbodies.edge_count,                            \
          sizeof(plumb_softbody_edge), 0)                                                          \
    ARRAY(plumb_softbody_bend, softbodies.bends, softbodies.bend_count,                            \
          sizeof(plumb_softbody_bend), 0)                                                          \
    ARRAY(plumb_softbody_triangle, softbodies.triangles, softbodies.triangle_count,                \
          sizeof(plumb_softbody_triangle), 0)                                                      \
    ARRAY(uint32_t, softbodies.rings, softbodies.ring_count, sizeof(uint32_t), 0)                  \
    ARRAY(plumb_softbody_pin, softbodies.pins, softbodies.pin_count, sizeof(plumb_softbody_pin),   \
          0)                                                                                       \
    ARRAY(pl_soft_rest, softbodies.rests, softbodies.rest_count, sizeof(pl_soft_rest), 0)          \
    TALLY(softbodies.asleep_count) TALLY(softbodies.missed_count) LEFT(softbodies.step)

#define PL_STATE_LAWS(VALUE, TALLY, ARRAY, TABLE, OWN, LEFT)                                       \
    ARRAY(pl_law, laws.items, laws.count, sizeof(pl_law), 8)                                       \
    ARRAY(pl_law_formula, laws.formulas, laws.formula_count, offsetof(pl_law_formula, program), 8)  \
    ARRAY(plumb_orbit_desc, laws.orbits, laws.orbit_count, sizeof(plumb_orbit_desc), 0)            \
    LEFT(laws.step)

#define PL_STATE_WAVES(VALUE, TALLY, ARRAY, TABLE, OWN, LEFT)                                      \
    ARRAY(pl_wave_surface, waves.items, waves.count, sizeof(pl_wave_surface), 8)                   \
    ARRAY(plumb_wave_mode, waves.modes, waves.mode_count, sizeof(plumb_wave_mode), 0)              \
    LEFT(waves.step)

// Who is about to break; scratch; and events, which a restored world has none of.
#define PL_STATE_FRACTURE(VALUE, TALLY, ARRAY, TABLE, OWN, LEFT)                                   \
    LEFT(fracture.fragments) LEFT(fracture.parts) LEFT(fracture.children) LEFT(fracture.shapes)    \
    LEFT(fracture.fragment_count) LEFT(fracture.part_count) LEFT(fracture.child_count)             \
    LEFT(fracture.shape_count) LEFT(fracture.breaks) LEFT(fracture.pieces)                         \
    LEFT(fracture.break_count) LEFT(fracture.piece_count) LEFT(fracture.events_told)               \
    LEFT(fracture.before)                                                                          \
    ARRAY(pl_pending_break, fracture.pending, fracture.pending_count, sizeof(pl_pending_break), 0)

#define PL_STATE_HEATS(VALUE, TALLY, ARRAY, TABLE, OWN, LEFT)                                      \
    ARRAY(pl_heat, heats.items, heats.count, sizeof(pl_heat), 8)                                   \
    ARRAY(pl_heat_state, heats.state, heats.state_count, sizeof(pl_heat_state), 0)                 \
    LEFT(heats.step) LEFT(heats.gone_count)

#define PL_STATE_CONTINUOUS(VALUE, TALLY, ARRAY, TABLE, OWN, LEFT)                                 \
    LEFT(continuous.movers) LEFT(continuous.count) VALUE(continuous.least_slack)                   \
    LEFT(continuous.noting) LEFT(continuous.stopped_count)

#define PL_STATE_QUARANTINE(VALUE, TALLY, ARRAY, TABLE, OWN, LEFT)                                 \
    LEFT(quarantine.events) LEFT(quarantine.event_count) LEFT(quarantine.again)                    \
    LEFT(quarantine.lost) LEFT(quarantine.attempt) LEFT(quarantine.joints)                         \
    LEFT(quarantine.rolling) LEFT(quarantine.kept) LEFT(quarantine.since)

#define PL_STATE_EFFECTS(VALUE, TALLY, ARRAY, TABLE, OWN, LEFT)                                    \
    ARRAY(pl_body_settings, settings.items, settings.count, PL_SETTINGS_HASHED, 8)                     \
    TALLY(settings.dragged) TALLY(settings.engines) TALLY(settings.breakable) TALLY(settings.dipoles) VALUE(settings.damped) VALUE(settings.capped) VALUE(settings.scaled) VALUE(settings.frozen)        \
    ARRAY(pl_target, targets.items, targets.count, sizeof(pl_target), 8)                           \
    ARRAY(pl_track, tracks.items, tracks.count, sizeof(pl_track), 8)

#define PL_STATE_DIAL(VALUE, TALLY, ARRAY, TABLE, OWN, LEFT)                                       \
    VALUE(dial.tier) TALLY(dial.reason) VALUE(dial.elapsed) VALUE(dial.speed) VALUE(dial.push)     \
    VALUE(dial.need) VALUE(dial.loose) TALLY(dial.motion) TALLY(dial.frozen) VALUE(dial.rest)      \
    TALLY(dial.worst) TALLY(dial.steps) TALLY(dial.solved) TALLY(dial.told)

// What lies in struct plumb_world itself.
#define PL_STATE_WORLD(VALUE, TALLY, ARRAY, TABLE, OWN, LEFT)                                      \
    LEFT(memory) LEFT(query_grids) LEFT(lookahead) VALUE(gravity) VALUE(step_count) VALUE(time) TALLY(last_dt) VALUE(soft_substep) TALLY(arrested_count)                \
    TABLE(bodies) VALUE(dynamic_count) VALUE(kinematic_count) VALUE(asleep_count)                  \
    VALUE(disabled_count) VALUE(continuous_bodies) VALUE(locked_bodies)                            \
    LEFT(one_way_noted) VALUE(one_way_pieces) VALUE(dropping_bodies)                                                   \
    OWN(tombstones) LEFT(tasks)                                                                        \
    VALUE(shape_count) VALUE(serial) LEFT(made) LEFT(outline)                                      \
    TABLE(materials) OWN(components) OWN(systems)                                                  \
    ARRAY(uint32_t, moving, moving_count, sizeof(uint32_t), 0) LEFT(poses)                         \
    TALLY(rows_moved) TALLY(pairs_dirty) TALLY(static_dirty) TALLY(rearranged)                     \
    LEFT(schedule_dirty)                                                                           \
    VALUE(piece_kinds) VALUE(turning_bodies)                                                       \
    VALUE(sensor_pieces) VALUE(filtered_pieces) VALUE(part_pieces)                                 \
    ARRAY(uint64_t, excluded, excluded_count, sizeof(uint64_t), 8)                                 \
    ARRAY(pl_material_pair, material_pairs, material_pair_count,                                   \
          sizeof(uint64_t) + sizeof(plumb_material_pair), 8)                                       \
    LEFT(schedule) LEFT(effects) LEFT(measure) LEFT(watchdog) LEFT(exact) LEFT(contact_index) LEFT(begin_events) LEFT(end_events) LEFT(changed_pairs) LEFT(hit_events)                            \
    LEFT(begin_count) LEFT(end_count) LEFT(hit_count)                                              \
    LEFT(checking) LEFT(checked) LEFT(observer) LEFT(locked_by) LEFT(editing) VALUE(edited) LEFT(in_hook) LEFT(error) LEFT(error_text)

#define PL_STATE(...)                                                                              \
    PL_STATE_WORLD(__VA_ARGS__) PL_STATE_DESC(__VA_ARGS__) PL_STATE_REGISTRY(__VA_ARGS__)          \
    PL_STATE_PIECES(__VA_ARGS__) PL_STATE_VERTICES(__VA_ARGS__) PL_STATE_COMMANDS(__VA_ARGS__)     \
    PL_STATE_BROAD(__VA_ARGS__) PL_STATE_NARROW(__VA_ARGS__) PL_STATE_SOLVER(__VA_ARGS__)          \
    PL_STATE_JOINTS(__VA_ARGS__) PL_STATE_PARTS(__VA_ARGS__) PL_STATE_PENDING_HITS(__VA_ARGS__)           \
    PL_STATE_SENSING(__VA_ARGS__) PL_STATE_SLEEP(__VA_ARGS__) PL_STATE_INTERNAL_EDGES(__VA_ARGS__)          \
    PL_STATE_CHARACTERS(__VA_ARGS__) PL_STATE_CONTINUOUS(__VA_ARGS__) PL_STATE_LIQUID(__VA_ARGS__)  \
    PL_STATE_AIR(__VA_ARGS__)                                                                      \
    PL_STATE_FRACTURE(__VA_ARGS__) PL_STATE_HEATS(__VA_ARGS__)                                     \
    PL_STATE_SOFTBODIES(__VA_ARGS__) PL_STATE_LAWS(__VA_ARGS__) PL_STATE_WAVES(__VA_ARGS__)                                                                     \
    PL_STATE_QUARANTINE(__VA_ARGS__) PL_STATE_EFFECTS(__VA_ARGS__)                                \
    PL_STATE_DIAL(__VA_ARGS__)

// [B] at the start of an element that are saved. Behind it lies what every step fills before reading.
#define PL_SAVED_BYTES(type)                                                                       \
    _Generic((type *)0, pl_joint *: offsetof(pl_joint, pose_a),                             \
             pl_sleeping_contact *: offsetof(pl_sleeping_contact, last),                                         \
             pl_island *: offsetof(pl_island, recalled), default: sizeof(type))
// [B] from its start to an index into what the last step made; -1: none. It is saved as 0, or PL_NONE.
#define PL_PASSING_INDEX(type)                                                                     \
    _Generic((type *)0, pl_pair *: (int)offsetof(pl_pair, manifold), default: -1)

// Members of a joint that decide later steps: what hash.c hashes of it. (Eighths follow from rotations.)
#define PL_STATE_JOINT(X)                                                                          \
    X(entity) PL_JOINT_DESC_ROWS(PL_ROW_STATE, X) X(strained) X(desc.collide_connected)                 \
    X(a.body) X(a.next) X(a.local) X(a.start) X(a.turns)                                           \
    X(b.body) X(b.next) X(b.local) X(b.start) X(b.turns)                                           \
    X(axis) X(target) X(sum) X(impulse) X(h)

// What of them is 0 but of a cable, and of that alone hashed: hashes without cables are what they were before there were any.
#define PL_STATE_CABLE(X) X(desc.radius_a) X(desc.radius_b)

// The same of a character.
#define PL_STATE_CHARACTER(X)                                                                      \
    X(body) X(flies) X(walk) X(fly) X(jump) X(thrown) X(velocity) X(speed) X(left) X(rise) X(step_top) \
    X(on_ground) X(climbs) X(on_slope) X(at_wall) X(at_ceiling) X(crushed) X(slope_side)           \
    X(air_time) X(ground.body) X(ground.shape) X(ground.local) X(ground.normal) X(passing_count)   \
    X(pushed) X(push) X(push_speed) X(trod) X(weight) X(weight_speed)                              \
    X(desc.up) X(desc.max_slope) X(desc.skin) X(desc.step_height)                                  \
    X(desc.step_width) X(desc.snap_distance) X(desc.acceleration) X(desc.air_acceleration)         \
    X(desc.max_fall_speed) X(desc.mass) X(desc.push_force) X(desc.no_steps) X(desc.no_snap)        \
    X(desc.no_push) X(desc.no_air_control)
// clang-format on

// For rows of a kind that is not asked for.
#define PL_STATE_NO_VALUE(path)
#define PL_STATE_NO_TALLY(path)
#define PL_STATE_NO_ARRAY(type, buffer, count, hashed, key)
#define PL_STATE_NO_TABLE(path)
#define PL_STATE_NO_OWN(path)
#define PL_STATE_NO_LEFT(path)

// A world for sizeof.
#define PL_STATE_OF(path) (((plumb_world *)0)->path)

#endif

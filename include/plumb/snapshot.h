/// snapshot.h - the state of a world as bytes: save, restore, roll back, send; and as a number: hash.
///
///     size_t size = plumb_world_snapshot_size(world);
///     void *image = malloc(size);
///     plumb_world_save(world, image, size);
///     plumb_world_step(world, dt); ...
///     plumb_world_restore(world, image, size); // every step from here gives the same bits again
///
/// In an image: bodies, shapes with their geometry, materials, joints, contacts with their impulses,
/// filters, sensors' overlaps, settings that decide motion, gravity, time, handles in use and to be used
/// next, user components, pending commands, which systems are switched off. User data are in it as
/// the pointers that they are, and so is whatever pointer a component holds: what they point to is
/// the user's to keep, and such an image means something in its own process only. Not in it: capacities,
/// SIMD width, hooks, user systems (code; register the same ones), timers, the last error, and the
/// events, contacts and counters of the last step: after a restore there are none until the next step.
/// Hooks of components are not called by a restore.
///
/// An image is of one build: format version, precision, byte order and columns must agree, and the world
/// must have the same components registered in the same order. Anything else, and every damage, is
/// refused whole: E_IMAGE, the state unchanged. A checksum guards against accidents; against forgery the
/// content is checked: handles, lists, counts, numbers and shapes are some that a world can have. What a
/// component holds is the user's to check (but that fields of bool are 0 or 1). So images may come from
/// strangers: the worst they can do is a strange world. A program that rolls back to images of its own can
/// leave the check out: plumb_world_restore_trusted.
///
/// No byte depends on capacities, addresses, threads, or on whether the world was restored meanwhile: worlds
/// with equal hashes and equal user data have equal images.
///
/// Rolling back: keep one image of the world as it was built (the base) and save frames against it: a
/// frame holds what is not as in the base. Restoring in a world that has held as much before allocates
/// nothing, nor does the next step; plumb_world_restore_frame_trusted is the quickest way back. For a network: plumb_snapshot_delta.
#ifndef PLUMB_SNAPSHOT_H
#define PLUMB_SNAPSHOT_H

#include "plumb/world.h"

PLUMB_BEGIN

/// 64 bits over all that decides later steps: every column of bodies, shapes and materials, joints,
/// contacts with their impulses, filters, settings, gravity, time, handles in use, user components,
/// pending commands. Two worlds that took the same calls have the same hash at every step, on any
/// machine, compiler and SIMD width of one precision; worlds that differ have different ones but for one
/// chance in 2^64. Not in it: user data, capacities, timers, the last error, events and contacts of
/// the last step. A component counts by its fields, or by its bytes when it was registered without
/// (padding and pointers in those would make it differ). A pending command counts but for user data. Not
/// cryptographic. 0 for null.
/// O(state): see src/snapshot/README.md.
PLUMB_API uint64_t plumb_world_hash(const plumb_world *world);

/// [B] of an image of the world as it is now, 0 for null. Contacts come and go: leave room for more, or
/// ask each time. O(1) in the size of the world.
PLUMB_API size_t plumb_world_snapshot_size(const plumb_world *world);

/// Writes the whole image; `buffer` needs no alignment. Its size is plumb_world_snapshot_size. On an
/// error what is in the buffer is undefined. O(state).
/// Errors: E_NULL, E_RANGE (size), E_LOCKED (called from a system or hook).
PLUMB_API plumb_result plumb_world_save(const plumb_world *world, void *buffer, size_t size);

/// Makes the world what it was when the image was saved, here or in another world: all handles mean
/// what they meant then. `size` may be larger than the image. The image may come from anybody: it is checked
/// whole before anything changes. O(state).
/// Errors: E_NULL, E_IMAGE, E_LOCKED, E_MEMORY.
PLUMB_API plumb_result plumb_world_restore(plumb_world *world, const void *buffer, size_t size);

/// The same for an image that this program has saved itself and that nobody else can have written to, as when
/// it rolls back: its checksum is verified, its content is taken as it is, and nothing is allocated where the
/// world has held as much before. With an image from anywhere else the behaviour is undefined.
/// Errors: E_NULL, E_IMAGE, E_LOCKED, E_MEMORY.
PLUMB_API plumb_result plumb_world_restore_trusted(plumb_world *world, const void *buffer,
                                                   size_t size);

/// Writes a frame: the columns and lists that differ from those of the image `base`; never more than
/// plumb_world_snapshot_size. *bytes tells how much. `base` is compared, not verified. O(state).
/// Errors: E_NULL, E_RANGE (size), E_LOCKED, E_IMAGE (base does not fit the world, or is a frame).
PLUMB_API plumb_result plumb_world_save_frame(const plumb_world *world, const void *base,
                                              size_t base_size, void *buffer, size_t size,
                                              size_t *bytes);

/// Restores a frame with the base that it was saved against. O(state).
/// Errors: E_NULL, E_IMAGE, E_LOCKED, E_MEMORY.
PLUMB_API plumb_result plumb_world_restore_frame(plumb_world *world, const void *base,
                                                 size_t base_size, const void *frame,
                                                 size_t frame_size);

/// The same for a frame and a base that this program has saved itself: see plumb_world_restore_trusted.
/// Errors: E_NULL, E_IMAGE, E_LOCKED, E_MEMORY.
PLUMB_API plumb_result plumb_world_restore_frame_trusted(plumb_world *world, const void *base,
                                                         size_t base_size, const void *frame,
                                                         size_t frame_size);

/// What an image tells of itself.
typedef struct plumb_snapshot_info {
    size_t bytes;        ///< [B] of the image
    bool is_frame;       ///< it needs its base
    uint64_t id;         ///< its checksum, which names it
    uint64_t base_id;    ///< of a frame: the id of its base
    uint64_t step_count; ///< steps taken when it was saved
    double time;         ///< [s] simulated when it was saved
} plumb_snapshot_info;

/// Verifies an image, or frame, and reads its header. O(bytes). Errors: E_NULL, E_IMAGE.
PLUMB_API plumb_result plumb_snapshot_read_info(const void *image, size_t size,
                                                plumb_snapshot_info *info);

/// [B] that a delta to an image of so many bytes takes at the most, whatever the image from which: the rule for slots.
/// A slot of plumb_snapshot_delta_bound(plumb_world_snapshot_size(world)) bytes, asked when the world is as large as it
/// gets (bodies and shapes made, contacts at their most), takes every delta between images of that world. A
/// slot for the usual delta may be much smaller: plumb_snapshot_delta tells how much one that does not fit wants, and
/// the image itself never needs more than the bound.
PLUMB_API size_t plumb_snapshot_delta_bound(size_t image_size);

/// Writes what turns the image `from` into the image `to`: both complete, or frames of one base. Small
/// where little changed: some 60 to 90 bytes a moving body in the float library. O(bytes).
/// Errors: E_NULL, E_RANGE (size: *bytes tells how much it takes), E_IMAGE (either is damaged, or they are not of the
/// same world).
PLUMB_API plumb_result plumb_snapshot_delta(const void *from, size_t from_size, const void *to,
                                            size_t to_size, void *buffer, size_t size,
                                            size_t *bytes);

/// Rebuilds `to`, bit for bit, in `buffer` of `size` bytes. O(bytes).
/// Errors: E_NULL, E_RANGE (size), E_IMAGE (either is damaged, or `from` is not the one of the delta).
PLUMB_API plumb_result plumb_snapshot_apply(const void *from, size_t from_size, const void *delta,
                                            size_t delta_size, void *buffer, size_t size,
                                            size_t *bytes);

PLUMB_END

#endif

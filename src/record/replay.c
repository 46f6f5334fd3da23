// replay.c - a recording run again: see plumb/record.h.
//
// A step takes the edits that were made before it, steps the world with the edits of the systems in their
// place, and compares the hash. An edit is a difference between two states: it is played only onto the
// state that it was taken from, which the hash of the step before vouches for; so a step that gives other bits
// ends the replay until it is taken back.
//
// Reads: the recording. Writes: its own world. Cost: a step the step itself and O(state) digested; one with
// edits two copies of the state more.
#include "record/replay.h"

#include "world/check.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

//---- errors --------------------------------------------------------------------------------------

static void tell(const plumb_replay_desc *desc, const char *text)
{
    if (desc->log != NULL) {
        desc->log(desc->hook_context, PLUMB_LOG_ERROR, text);
    }
}

plumb_result pl_replay_fail(plumb_replay *replay, plumb_result code, const char *function,
                            const char *format, ...)
{
    int used = snprintf(replay->error, sizeof replay->error, "%s: ", function);
    va_list list;
    va_start(list, format);
    vsnprintf(replay->error + used, sizeof replay->error - (size_t)used, format, list);
    va_end(list);
    if (code != PLUMB_E_MISSING) { // either end of a recording is where a loop ends, and no fault
        tell(&replay->desc, replay->error);
    }
    return code;
}

static plumb_result fail_memory(plumb_replay *replay, const char *function)
{
    return pl_replay_fail(replay, PLUMB_E_MEMORY, function, "the allocator returned no memory");
}

const char *plumb_replay_error(const plumb_replay *replay)
{
    return replay == NULL ? "" : replay->error;
}

//---- keyframes -----------------------------------------------------------------------------------

static void at_begin(pl_step_observer *self, plumb_world *world)
{
    (void)world;
    pl_replay_play_told((plumb_replay *)self);
}

static void after_systems(pl_step_observer *self, plumb_world *world, plumb_phase phase)
{
    pl_replay_play((plumb_replay *)self, pl_edit_mark(phase, world->quarantine.attempt), -1);
}

static void after_hook(pl_step_observer *self, plumb_world *world)
{
    plumb_replay *replay = (plumb_replay *)self;
    pl_replay_play(replay, pl_edit_mark(PLUMB_PHASE_END, world->quarantine.attempt), replay->hooks);
    replay->hooks += replay->hooks < PL_HOOKS_MOST;
}

static void after_pass(pl_step_observer *self, plumb_world *world, int pass)
{
    plumb_replay *replay = (plumb_replay *)self;
    if (replay->look != NULL) {
        replay->look(replay->look_context, world, pass);
    }
}

static plumb_result make_world(plumb_replay *replay)
{
    plumb_replay_desc *d = &replay->desc;
    const plumb_world_desc desc = { .simd_width = d->simd_width,
                                    .workers = d->workers,
                                    .allocator = d->allocator,
                                    .log = d->log,
                                    .hook_context = d->hook_context };
    PL_TRY(plumb_world_create(&desc, &replay->world));
    replay->observer = (pl_step_observer){ .replays = true,
                                           .begin = at_begin,
                                           .after = after_systems,
                                           .dropped = after_hook,
                                           .passed = after_pass };
    replay->world->observer = &replay->observer;
    replay->code = UINT32_MAX;
    return PLUMB_OK;
}

static void drop_world(plumb_replay *replay)
{
    plumb_world_destroy(replay->world);
    replay->world = NULL;
}

// The world becomes what it was there, registrations included.
static plumb_result restore_key(plumb_replay *replay, const char *fn, const pl_key_place *key)
{
    plumb_result r = PLUMB_OK;
    if (replay->code != UINT32_MAX && replay->code > key->code) {
        drop_world(replay); // nothing can be registered back
    }
    if (replay->world == NULL) {
        r = make_world(replay);
    }
    if (r == PLUMB_E_RANGE) {
        return pl_replay_fail(replay, r, fn,
                              "simd_width is %d, workers is %d; they must be as "
                              "for plumb_world_create",
                              replay->desc.simd_width, replay->desc.workers);
    }
    if (r == PLUMB_OK && replay->code != key->code) {
        r = pl_replay_register(replay, key->code);
    }
    r = r != PLUMB_OK ? r : plumb_world_restore(replay->world, key->data, key->bytes);
    if (r == PLUMB_E_MEMORY) {
        return fail_memory(replay, fn);
    }
    return r == PLUMB_OK ? PLUMB_OK
                         : pl_replay_fail(replay, PLUMB_E_IMAGE, fn,
                                          "the keyframe at step %llu cannot be restored: %s",
                                          (unsigned long long)key->step, plumb_result_text(r));
}

static plumb_result go_to_key(plumb_replay *replay, const char *fn, const pl_key_place *key)
{
    PL_TRY(restore_key(replay, fn, key));
    replay->step = key->step;
    replay->differs = false;
    replay->edit_count = 0;
    replay->failed = PLUMB_OK;
    return PLUMB_OK;
}

//---- open and close ------------------------------------------------------------------------------

plumb_result plumb_replay_open(const void *bytes, size_t size, const plumb_replay_desc *desc,
                               plumb_replay **replay)
{
    static const char fn[] = "plumb_replay_open";
    const plumb_replay_desc none = { 0 };
    plumb_replay form = { .desc = desc == NULL ? none : *desc };
    if (replay == NULL) {
        return pl_replay_fail(&form, PLUMB_E_NULL, fn, "replay is null; it must be given");
    }
    *replay = NULL;
    if (bytes == NULL) {
        return pl_replay_fail(&form, PLUMB_E_NULL, fn, "bytes is null; it must be given");
    }
    pl_memory_init(&form.memory, &form.desc.allocator);
    bool starved;
    const char *wrong = pl_index_make(&form.memory, bytes, size, &form.index, &starved);
    plumb_replay *made = NULL;
    plumb_result r = PLUMB_OK;
    if (wrong == NULL) {
        made = pl_resize(&form.memory, NULL, 0, sizeof *made);
        starved = made == NULL;
    }
    if (starved) {
        r = fail_memory(&form, fn);
    } else if (wrong != NULL) {
        r = pl_replay_fail(&form, PLUMB_E_IMAGE, fn, "bytes %s; it must be as it was recorded",
                           wrong);
    }
    if (r != PLUMB_OK) {
        pl_index_free(&form.memory, &form.index);
        return r;
    }
    *made = form;
    r = go_to_key(made, fn, pl_index_key(&made->index, 0));
    if (r != PLUMB_OK) {
        plumb_replay_close(made);
        return r;
    }
    *replay = made;
    return PLUMB_OK;
}

void plumb_replay_close(plumb_replay *replay)
{
    if (replay == NULL) {
        return;
    }
    drop_world(replay);
    pl_memory memory = replay->memory;
    pl_index_free(&memory, &replay->index);
    pl_buffer_free(&memory, &replay->before.buffer);
    pl_buffer_free(&memory, &replay->now.buffer);
    pl_buffer_free(&memory, &replay->edits);
    pl_resize(&memory, replay, sizeof *replay, 0);
}

//---- steps ---------------------------------------------------------------------------------------

// What the user did before the step: edits, or a keyframe where something was registered.
static plumb_result play_head(plumb_replay *replay, const char *fn)
{
    const pl_key_place *key = pl_index_key_of_edits(&replay->index, replay->step);
    if (key == NULL) {
        pl_replay_play(replay, 0, -1);
        return replay->failed;
    }
    bool listed = replay->desc.list_edits;
    if (listed && !pl_replay_keep(replay, &replay->before)) {
        return fail_memory(replay, fn);
    }
    PL_TRY(restore_key(replay, fn, key));
    if (listed && pl_replay_keep(replay, &replay->now)) {
        pl_replay_list(replay, -1, &replay->before.image, &replay->now.image);
    }
    return PLUMB_OK;
}

static plumb_result fail_differs(plumb_replay *replay, const char *fn)
{
    return pl_replay_fail(replay, PLUMB_E_IMAGE, fn,
                          "step %llu does not give the bits that were recorded; another build "
                          "recorded it, or the world was changed",
                          (unsigned long long)replay->step);
}

static plumb_result fail_play(plumb_replay *replay, const char *fn)
{
    replay->differs = true; // only going back makes the state whole again
    return replay->failed == PLUMB_E_MEMORY
               ? fail_memory(replay, fn)
               : pl_replay_fail(replay, PLUMB_E_IMAGE, fn,
                                "the edits of step %llu do not fit the world",
                                (unsigned long long)replay->step + 1);
}

static plumb_result take_step(plumb_replay *replay, const char *fn)
{
    if (replay->differs) {
        return fail_differs(replay, fn);
    }
    if (replay->step == replay->index.step_count) {
        return pl_replay_fail(replay, PLUMB_E_MISSING, fn, "the recording ends here, at step %llu",
                              (unsigned long long)replay->step);
    }
    pl_step_head head = pl_index_step_head(&replay->index, replay->step);
    replay->edit_count = 0;
    replay->hooks = 0;
    replay->failed = PLUMB_OK;
    replay->playing = pl_index_step(&replay->index, replay->step);
    plumb_result r = play_head(replay, fn);
    if (r == PLUMB_OK) {
        after_pass(&replay->observer, replay->world, -1);
        r = plumb_world_step(replay->world, (plumb_real)head.dt);
        r = r != PLUMB_OK ? r : replay->failed;
    }
    replay->playing = NULL;
    if (r != PLUMB_OK) {
        replay->failed = r;
        return fail_play(replay, fn);
    }
    ++replay->step;
    if (plumb_world_hash(replay->world) != head.hash) {
        replay->differs = true;
        return fail_differs(replay, fn);
    }
    return PLUMB_OK;
}

// The last step until then that moved anything: one of dt 0 shows the contacts that it left.
static uint64_t moved_by(const plumb_replay *replay, uint64_t step)
{
    while (step > 0 && !(pl_index_step_head(&replay->index, step - 1).dt > 0)) {
        --step;
    }
    return step;
}

static plumb_result seek(plumb_replay *replay, const char *fn, uint64_t step)
{
    const pl_key_place *key = pl_index_key_before(&replay->index, moved_by(replay, step));
    bool onward = step >= replay->step && !replay->differs && replay->step >= key->step;
    if (step == replay->step && !replay->differs) {
        return PLUMB_OK;
    }
    plumb_result r = onward ? PLUMB_OK : go_to_key(replay, fn, key);
    while (r == PLUMB_OK && replay->step < step) {
        r = take_step(replay, fn);
    }
    return r;
}

plumb_result plumb_replay_step(plumb_replay *replay)
{
    return replay == NULL ? PLUMB_E_NULL : take_step(replay, __func__);
}

plumb_result plumb_replay_step_back(plumb_replay *replay)
{
    if (replay == NULL) {
        return PLUMB_E_NULL;
    }
    if (replay->step == 0) {
        return pl_replay_fail(replay, PLUMB_E_MISSING, __func__,
                              "the recording begins here, at step 0");
    }
    return seek(replay, __func__, replay->step - 1);
}

plumb_result plumb_replay_seek(plumb_replay *replay, uint64_t step)
{
    if (replay == NULL) {
        return PLUMB_E_NULL;
    }
    if (step > replay->index.step_count) {
        return pl_replay_fail(replay, PLUMB_E_RANGE, __func__, "step is %llu; it must be 0 to %llu",
                              (unsigned long long)step,
                              (unsigned long long)replay->index.step_count);
    }
    return seek(replay, __func__, step);
}

//---- what it is ----------------------------------------------------------------------------------

plumb_world *plumb_replay_world(plumb_replay *replay)
{
    return replay == NULL ? NULL : replay->world;
}

// [s] of the world after `step` steps.
static double time_at(const plumb_replay *replay, uint64_t step)
{
    if (step > 0) {
        return pl_index_step_head(&replay->index, step - 1).time;
    }
    const pl_key_place *key = pl_index_key(&replay->index, 0);
    pl_image_header header;
    memcpy(&header, key->data, sizeof header);
    return header.time;
}

uint64_t plumb_replay_find(const plumb_replay *replay, double time)
{
    if (replay == NULL) {
        return 0;
    }
    uint64_t low = 0, high = replay->index.step_count;
    while (low < high) {
        uint64_t middle = low + (high - low + 1) / 2;
        if (time_at(replay, middle) <= time) {
            low = middle;
        } else {
            high = middle - 1;
        }
    }
    return low;
}

plumb_result plumb_replay_get_info(const plumb_replay *replay, plumb_replay_info *info)
{
    if (replay == NULL || info == NULL) {
        return PLUMB_E_NULL;
    }
    const pl_index *index = &replay->index;
    pl_image_header head;
    memcpy(&head, pl_index_key(index, 0)->data, sizeof head);
    *info = (plumb_replay_info){ .title = index->header.title,
                                 .steps = index->step_count,
                                 .step = replay->step,
                                 .step_count = head.step_count,
                                 .start = head.time,
                                 .end = time_at(replay, index->step_count),
                                 .time = time_at(replay, replay->step),
                                 .keyframes = index->key_count,
                                 .edited = index->edited,
                                 .bytes = index->bytes,
                                 .keyframe_every = (int)index->header.keyframe_every,
                                 .complete = index->complete,
                                 .differs = replay->differs };
    if (replay->step > 0) {
        pl_step_head step = pl_index_step_head(index, replay->step - 1);
        info->dt = step.dt;
        info->hash = step.hash;
    } else {
        info->hash = plumb_world_hash(replay->world);
    }
    return PLUMB_OK;
}

const char *plumb_replay_name(const plumb_replay *replay, plumb_entity entity)
{
    const pl_kept_place *name =
        replay == NULL ? NULL
                       : pl_kept_find(&replay->index.names, pl_key(entity.index, entity.generation),
                                      UINT64_MAX);
    return name == NULL ? NULL : name->data;
}

const void *plumb_replay_note(const plumb_replay *replay, uint64_t key, size_t *size)
{
    const pl_kept_place *note =
        replay == NULL ? NULL : pl_kept_find(&replay->index.notes, key, replay->step);
    bool holds = note != NULL && note->bytes > 0;
    if (size != NULL) {
        *size = holds ? note->bytes : 0;
    }
    return holds ? note->data : NULL;
}

int plumb_replay_edits(const plumb_replay *replay, plumb_replay_edit *rows, int capacity)
{
    if (replay == NULL) {
        return 0;
    }
    int most = rows == NULL || capacity < 0 ? 0 : capacity;
    int count = replay->edit_count < most ? replay->edit_count : most;
    if (count > 0) {
        memcpy(rows, replay->edits.data, (size_t)count * sizeof *rows);
    }
    return replay->edit_count;
}

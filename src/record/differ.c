// differ.c - the first step, pass, entity and component in which two recordings are not the same.
//
// Both are replayed side by side, a digest of all but the settings is compared after each step. The step
// that differs is taken again twice: with a digest after each pass, which names the pass; and with an
// image behind that pass, which names the rest.
//
// Reads: both worlds. Writes: nothing. Cost: both replays, two digests a step.
#include "record/compare.h"
#include "record/replay.h"
#include "step/pass.h"
#include "world/check.h"

#include <string.h>

#define PASSES (PL_PASS_MAX + 1) // the first one: what the user did before the step

// What was seen in a step.
typedef struct passes {
    plumb_replay *replay;
    uint64_t step;           // taken before it
    uint64_t digest[PASSES]; // behind each pass; 0: it did not run
    int wanted;              // place of the pass behind which an image is to be taken; -1: none
    pl_played_image image;
} passes;

// What a pass leaves to the next ones besides the state. Numbers that are not always written are left out.
static void add_products(pl_digest *digest, const plumb_world *world)
{
    const pl_manifold *m = pl_manifolds(&world->narrow);
    for (uint32_t i = 0; i < world->narrow.manifold_count; ++i) {
        pl_digest_add(digest, &m[i], offsetof(pl_manifold, point));
        for (uint32_t k = 0; k < m[i].count; ++k) {
            pl_digest_add(digest, &m[i].point[k], offsetof(pl_manifold_point, total));
        }
    }
    const pl_solver *s = &world->solver;
    for (uint32_t row = 0; s->slot_count > 0 && row < world->dynamic_count; ++row) {
        const uint32_t slot = ((const uint32_t *)s->slots.data)[row]; // their order means nothing
        if (slot != PL_NONE) {
            pl_digest_add(digest, &pl_solver_bodies(s)[slot], sizeof(pl_solver_body));
        }
    }
}

static void look(void *context, plumb_world *world, int pass)
{
    passes *p = context;
    pl_digest digest;
    const uint64_t state = pl_world_digest(world, false);
    pl_digest_begin(&digest);
    pl_digest_add(&digest, &state, sizeof state);
    if (pass >= 0) { // before, there may be those of the last step, or not
        add_products(&digest, world);
    }
    p->digest[pass + 1] = pl_digest_end(&digest);
    if (pass + 1 == p->wanted) {
        pl_replay_keep(p->replay, &p->image);
    }
}

// Takes the step again.
static plumb_result again(passes *p)
{
    plumb_replay *replay = p->replay;
    memset(p->digest, 0, sizeof p->digest);
    PL_TRY(plumb_replay_seek(replay, p->step));
    replay->look = look;
    replay->look_context = p;
    PL_TRY(plumb_replay_step(replay));
    replay->look = NULL;
    return PLUMB_OK;
}

// The first pass from `from` on behind which they differ; a pass that only one took leaves the other as
// it was.
static int first_pass(const passes *a, const passes *b, int from)
{
    uint64_t at_a = 0, at_b = 0;
    for (int i = 0; i < PASSES; ++i) {
        at_a = a->digest[i] != 0 ? a->digest[i] : at_a;
        at_b = b->digest[i] != 0 ? b->digest[i] : at_b;
        if (i >= from && at_a != at_b) {
            return i;
        }
    }
    return PASSES;
}

static const char *name_of(int place)
{
    return place == 0 ? "edits" : place <= pl_pass_count ? pl_passes[place - 1].name : "step";
}

// What differs behind the pass, or behind the next one of which a user can tell.
static plumb_result find_first(passes *a, passes *b, plumb_replay_difference *out)
{
    PL_TRY(again(a));
    PL_TRY(again(b));
    int pass = first_pass(a, b, 0);
    int count = 0;
    out->pass = name_of(pass);
    while (pass < PASSES && count == 0) {
        a->wanted = b->wanted = pass;
        a->image.image.bytes = b->image.image.bytes = NULL;
        PL_TRY(again(a));
        PL_TRY(again(b));
        if (a->image.image.bytes != NULL && b->image.image.bytes != NULL) {
            count = pl_compare_images(a->replay->world, &a->image.image, &b->image.image, false,
                                      &out->first, 1);
        }
        pass = first_pass(a, b, pass + 1);
    }
    return PLUMB_OK;
}

static uint64_t state_of(const plumb_replay *replay)
{
    return pl_world_digest(replay->world, false);
}

static bool has_next(const plumb_replay *replay)
{
    return replay->step < replay->index.step_count;
}

static plumb_result fill(plumb_replay *a, plumb_replay *b, plumb_replay_difference *out)
{
    plumb_replay_info at_a = { 0 }, at_b = { 0 };
    plumb_replay_get_info(a, &at_a);
    plumb_replay_get_info(b, &at_b);
    *out = (plumb_replay_difference){ .found = true,
                                      .step = at_b.step,
                                      .time = { at_a.time, at_b.time },
                                      .pass = "head",
                                      .seen = at_b.step };
    if (!pl_replay_keep(a, &a->before) || !pl_replay_keep(b, &b->before)) {
        return pl_replay_fail(a, PLUMB_E_MEMORY, "plumb_replay_compare",
                              "the allocator returned no memory");
    }
    pl_compare_images(a->world, &a->before.image, &b->before.image, false, &out->first, 1);
    return PLUMB_OK;
}

//---- recordings of other builds ------------------------------------------------------------------

// The first keyframe after `a` steps of A, and as many more of B as of A, that both have.
static void see_keyframes(const plumb_replay *a, const plumb_replay *b, uint64_t step_a,
                          uint64_t step_b, plumb_replay_difference *out)
{
    uint32_t i = 0, k = 0;
    while (i < a->index.key_count && k < b->index.key_count) {
        const pl_key_place *ka = pl_index_key(&a->index, i), *kb = pl_index_key(&b->index, k);
        pl_image ia, ib;
        if (ka->step < step_a || ka->step - step_a + step_b < kb->step) {
            ++i;
        } else if (kb->step < ka->step - step_a + step_b) {
            ++k;
        } else {
            if (pl_image_open(ka->data, ka->bytes, false, &ia) == NULL &&
                pl_image_open(kb->data, kb->bytes, false, &ib) == NULL &&
                pl_compare_images(a->world, &ia, &ib, false, &out->first, 1) > 0) {
                out->seen = kb->step;
            }
            return;
        }
    }
}

// What the recordings themselves say from there on, where both were alike. False: nothing, for their
// settings are in the hashes.
static bool compare_recorded(const plumb_replay *a, const plumb_replay *b, uint64_t step_a,
                             uint64_t step_b, plumb_replay_difference *out)
{
    uint64_t first = step_a;
    for (; step_a < a->index.step_count && step_b < b->index.step_count; ++step_a, ++step_b) {
        pl_step_head ha = pl_index_step_head(&a->index, step_a);
        pl_step_head hb = pl_index_step_head(&b->index, step_b);
        if (ha.hash != hb.hash && step_a == first) {
            return false;
        }
        if (ha.hash != hb.hash) {
            *out = (plumb_replay_difference){
                .found = true, .step = step_b + 1, .time = { ha.time, hb.time }, .pass = ""
            };
            see_keyframes(a, b, step_a + 1, step_b + 1, out);
            return true;
        }
    }
    return true;
}

plumb_result plumb_replay_compare(plumb_replay *a, plumb_replay *b,
                                  plumb_replay_difference *difference)
{
    if (a == NULL || b == NULL || difference == NULL) {
        return PLUMB_E_NULL;
    }
    *difference = (plumb_replay_difference){ .pass = "" };
    plumb_result r = PLUMB_OK;
    if (pl_section_user_schema(a->world) != pl_section_user_schema(b->world)) {
        return pl_replay_fail(a, PLUMB_E_IMAGE, __func__,
                              "a and b have other components; record the same ones");
    }
    if (state_of(a) != state_of(b)) {
        return fill(a, b, difference);
    }
    const uint64_t from_a = a->step, from_b = b->step;
    bool differ = false;
    while (r == PLUMB_OK && !differ && has_next(a) && has_next(b)) {
        r = plumb_replay_step(a);
        r = r != PLUMB_OK ? r : plumb_replay_step(b);
        differ = r == PLUMB_OK && state_of(a) != state_of(b);
    }
    if (r == PLUMB_E_IMAGE && compare_recorded(a, b, from_a, from_b, difference)) {
        return PLUMB_OK;
    }
    if (!differ) {
        return r;
    }
    passes seen[2] = { { .replay = a, .step = a->step - 1, .wanted = -1 },
                       { .replay = b, .step = b->step - 1, .wanted = -1 } };
    r = fill(a, b, difference);
    r = r != PLUMB_OK ? r : find_first(&seen[0], &seen[1], difference);
    pl_buffer_free(&a->memory, &seen[0].image.buffer);
    pl_buffer_free(&b->memory, &seen[1].image.buffer);
    return r;
}

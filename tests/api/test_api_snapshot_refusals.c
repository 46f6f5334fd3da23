// test_api_snapshot_refusals.c - images, frames and deltas that are refused; memory that runs out.
#include "snapshot_fixture.h"

//---- refusals ------------------------------------------------------------------------------------
static void damage_is_refused_whole(void **state)
{
    (void)state;
    pile p;
    make_pile(&p, (plumb_world_desc){ 0 }, 20);
    image base = save(p.world);
    step(p.world, 3);
    image frame = save_frame(p.world, base), whole = save(p.world);
    step(p.world, 3);
    uint64_t hash = plumb_world_hash(p.world);
    plumb_snapshot_info info;
    for (size_t i = 0; i < whole.size; ++i) {
        whole.bytes[i] ^= (char)(1 + i % 255);
        assert_int_equal(plumb_world_restore(p.world, whole.bytes, whole.size), PLUMB_E_IMAGE);
        whole.bytes[i] ^= (char)(1 + i % 255);
        assert_int_equal(plumb_world_restore(p.world, whole.bytes, i), PLUMB_E_IMAGE);
    }
    for (size_t i = 0; i < frame.size; ++i) {
        frame.bytes[i] ^= (char)0x80;
        assert_int_equal(
            plumb_world_restore_frame(p.world, base.bytes, base.size, frame.bytes, frame.size),
            PLUMB_E_IMAGE);
        frame.bytes[i] ^= (char)0x80;
        assert_int_equal(plumb_world_restore_frame(p.world, base.bytes, base.size, frame.bytes, i),
                         PLUMB_E_IMAGE);
    }
    for (size_t i = 0; i < base.size; i += 7) {
        base.bytes[i] ^= 1;
        assert_int_equal(
            plumb_world_restore_frame(p.world, base.bytes, base.size, frame.bytes, frame.size),
            PLUMB_E_IMAGE);
        assert_int_equal(plumb_snapshot_read_info(base.bytes, base.size, &info), PLUMB_E_IMAGE);
        base.bytes[i] ^= 1;
    }
    assert_true(plumb_world_hash(p.world) == hash);
    assert_int_equal(plumb_world_restore(p.world, whole.bytes, whole.size), PLUMB_OK);
    free(base.bytes);
    free(frame.bytes);
    free(whole.bytes);
    plumb_world_destroy(p.world);
}

static void damaged_deltas_are_refused(void **state)
{
    (void)state;
    pile p;
    make_pile(&p, (plumb_world_desc){ 0 }, 20);
    image from = save(p.world);
    step(p.world, 2);
    image to = save(p.world);
    char *delta = malloc(plumb_snapshot_delta_bound(to.size)), *out = malloc(to.size);
    size_t size, back;
    plumb_snapshot_delta(from.bytes, from.size, to.bytes, to.size, delta,
                         plumb_snapshot_delta_bound(to.size), &size);
    for (size_t i = 0; i < size; ++i) {
        delta[i] ^= (char)(1 + i % 255);
        assert_int_equal(
            plumb_snapshot_apply(from.bytes, from.size, delta, size, out, to.size, &back),
            PLUMB_E_IMAGE);
        delta[i] ^= (char)(1 + i % 255);
        assert_int_equal(plumb_snapshot_apply(from.bytes, from.size, delta, i, out, to.size, &back),
                         PLUMB_E_IMAGE);
    }
    // Not the image that it was made from.
    assert_int_equal(plumb_snapshot_apply(to.bytes, to.size, delta, size, out, to.size, &back),
                     PLUMB_E_IMAGE);
    assert_int_equal(
        plumb_snapshot_apply(from.bytes, from.size, delta, size, out, to.size - 1, &back),
        PLUMB_E_RANGE);
    assert_int_equal(plumb_snapshot_apply(from.bytes, from.size, delta, size, out, to.size, &back),
                     PLUMB_OK);
    char small[64];
    assert_int_equal(
        plumb_snapshot_delta(from.bytes, from.size, to.bytes, to.size, small, sizeof small, &size),
        PLUMB_E_RANGE);
    from.bytes[100] ^= 1;
    assert_int_equal(plumb_snapshot_delta(from.bytes, from.size, to.bytes, to.size, delta,
                                          plumb_snapshot_delta_bound(to.size), &size),
                     PLUMB_E_IMAGE);
    assert_int_equal(plumb_snapshot_delta(NULL, 0, to.bytes, to.size, delta, 1, &size),
                     PLUMB_E_NULL);
    assert_int_equal(plumb_snapshot_apply(from.bytes, from.size, NULL, 0, out, 1, &back),
                     PLUMB_E_NULL);
    free(from.bytes);
    free(to.bytes);
    free(delta);
    free(out);
    plumb_world_destroy(p.world);
}

// A header with one number changed; the checksum is not reached.
static void foreign(char *header, size_t at, size_t bytes)
{
    for (size_t i = 0; i < bytes / 2; ++i) {
        char swapped = header[at + i];
        header[at + i] = header[at + bytes - 1 - i];
        header[at + bytes - 1 - i] = swapped;
    }
}

static void refusals_say_why(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    image i = save(w);
    REFUSED(E_NULL, "plumb_world_save: buffer is null; it must be given",
            plumb_world_save(w, NULL, 10));
    char text[160];
    snprintf(text, sizeof text,
             "plumb_world_save: size is %zu; it must be at least %zu in this world now", i.size - 1,
             i.size);
    REFUSED(E_RANGE, text, plumb_world_save(w, i.bytes, i.size - 1));
    snprintf(text, sizeof text,
             "plumb_world_save: size is 3; it must be at least %zu in this world now", i.size);
    REFUSED(E_RANGE, text, plumb_world_save(w, i.bytes, 3));
    assert_int_equal(plumb_world_save(w, i.bytes, i.size), PLUMB_OK);
    REFUSED(E_NULL, "plumb_world_restore: buffer is null; it must be given",
            plumb_world_restore(w, NULL, 10));
    REFUSED(E_IMAGE, "plumb_world_restore: buffer is truncated; it must be as it was saved",
            plumb_world_restore(w, i.bytes, i.size - 1));
    i.bytes[i.size - 1] ^= 1;
    REFUSED(E_IMAGE, "plumb_world_restore: buffer is damaged; it must be as it was saved",
            plumb_world_restore(w, i.bytes, i.size));
    i.bytes[i.size - 1] ^= 1;
    i.bytes[8] ^= 1;
    REFUSED(E_IMAGE,
            "plumb_world_restore: buffer is of another version of the format; it must be as it was "
            "saved",
            plumb_world_restore(w, i.bytes, i.size));
    i.bytes[8] ^= 1;
    i.bytes[12] ^= 12; // 4 <-> 8
    REFUSED(E_IMAGE,
            "plumb_world_restore: buffer is of a world of another precision; it must be as it was "
            "saved",
            plumb_world_restore(w, i.bytes, i.size));
    i.bytes[12] ^= 12;
    i.bytes[32] ^= 1;
    REFUSED(E_IMAGE,
            "plumb_world_restore: buffer was made by a build that stores other columns; it must be "
            "as it was saved",
            plumb_world_restore(w, i.bytes, i.size));
    i.bytes[32] ^= 1;
    i.bytes[0] ^= 1;
    REFUSED(E_IMAGE,
            "plumb_world_restore: buffer is no image of a world; it must be as it was saved",
            plumb_world_restore(w, i.bytes, i.size));
    i.bytes[0] ^= 1;
    foreign(i.bytes, 0, 8);
    REFUSED(E_IMAGE,
            "plumb_world_restore: buffer was made on a machine of another byte order; it must be "
            "as it was saved",
            plumb_world_restore(w, i.bytes, i.size));
    foreign(i.bytes, 0, 8);
    image frame = save_frame(w, i);
    REFUSED(E_IMAGE,
            "plumb_world_restore: buffer is a frame; plumb_world_restore_frame takes it with its "
            "base",
            plumb_world_restore(w, frame.bytes, frame.size));
    size_t bytes;
    REFUSED(E_IMAGE, "plumb_world_save_frame: base is a frame; it must come from plumb_world_save",
            plumb_world_save_frame(w, frame.bytes, frame.size, i.bytes, i.size, &bytes));
    REFUSED(E_NULL, "plumb_world_save_frame: bytes is null; it must be given",
            plumb_world_save_frame(w, i.bytes, i.size, frame.bytes, frame.size, NULL));
    REFUSED(E_NULL, "plumb_world_save_frame: base is null; it must be given",
            plumb_world_save_frame(w, NULL, 0, frame.bytes, frame.size, &bytes));
    REFUSED(E_NULL, "plumb_world_save_frame: buffer is null; it must be given",
            plumb_world_save_frame(w, i.bytes, i.size, NULL, frame.size, &bytes));
    snprintf(text, sizeof text,
             "plumb_world_save_frame: size is %zu; it must be at least %zu in this world now",
             frame.size - 1, frame.size);
    REFUSED(E_RANGE, text,
            plumb_world_save_frame(w, i.bytes, i.size, frame.bytes, frame.size - 1, &bytes));
    assert_int_equal(plumb_world_save_frame(w, i.bytes, i.size, frame.bytes, frame.size, &bytes),
                     PLUMB_OK);
    plumb_body_set_velocity(w, f->dynamic, plumb_v2(1, 1));
    image other = save(w);
    REFUSED(E_IMAGE, "plumb_world_restore_frame: base is not the one that the frame was made with",
            plumb_world_restore_frame(w, other.bytes, other.size, frame.bytes, frame.size));
    REFUSED(E_NULL, "plumb_world_restore_frame: frame is null; it must be given",
            plumb_world_restore_frame(w, i.bytes, i.size, NULL, 0));
    REFUSED(E_NULL, "plumb_world_restore_frame: base is null; it must be given",
            plumb_world_restore_frame(w, NULL, 0, frame.bytes, frame.size));
    plumb_component_create(w, &(plumb_component_desc){ .name = "more", .size = 1 });
    REFUSED(E_IMAGE,
            "plumb_world_restore: buffer has other components; register the same ones in the same "
            "order",
            plumb_world_restore(w, i.bytes, i.size));
    assert_int_equal(plumb_world_save(NULL, i.bytes, i.size), PLUMB_E_NULL);
    assert_int_equal(plumb_world_restore(NULL, i.bytes, i.size), PLUMB_E_NULL);
    assert_int_equal(plumb_world_save_frame(NULL, i.bytes, 1, i.bytes, 1, &bytes), PLUMB_E_NULL);
    assert_int_equal(plumb_world_restore_frame(NULL, i.bytes, 1, i.bytes, 1), PLUMB_E_NULL);
    assert_int_equal(plumb_snapshot_read_info(NULL, 0, NULL), PLUMB_E_NULL);
    assert_int_equal(plumb_world_snapshot_size(NULL), 0);
    free(i.bytes);
    free(frame.bytes);
    free(other.bytes);
}

typedef struct attempt {
    char *bytes;
    size_t size;
    plumb_result saved, restored;
    char message[128];
} attempt;

static void try_inside(const plumb_system_call *call)
{
    attempt *a = call->context;
    a->saved = plumb_world_save(call->world, a->bytes, a->size);
    strncpy(a->message, plumb_world_error(call->world).message, sizeof a->message - 1);
    a->restored = plumb_world_restore(call->world, a->bytes, a->size);
}

static void a_stepping_world_is_locked(void **state)
{
    fixture *f = *state;
    image i = save(f->world);
    attempt a = { .bytes = i.bytes, .size = i.size };
    plumb_system_create(f->world, &(plumb_system_desc){ .name = "thief",
                                                        .phase = PLUMB_PHASE_END,
                                                        .run = try_inside,
                                                        .context = &a });
    step(f->world, 1);
    assert_int_equal(a.saved, PLUMB_E_LOCKED);
    assert_int_equal(a.restored, PLUMB_E_LOCKED);
    assert_string_equal(a.message, "plumb_world_save: the world is stepping (system 'thief'); "
                                   "call it between steps");
    free(i.bytes);
}

// What is trusted is the content: the rest is refused as ever.
static void trusted_images_are_verified_too(void **state)
{
    (void)state;
    pile p;
    make_pile(&p, (plumb_world_desc){ 0 }, 3);
    image base = save(p.world);
    assert_int_equal(plumb_world_restore_trusted(NULL, base.bytes, base.size), PLUMB_E_NULL);
    assert_int_equal(plumb_world_restore_trusted(p.world, NULL, 0), PLUMB_E_NULL);
    assert_int_equal(plumb_world_restore_frame_trusted(p.world, base.bytes, base.size, NULL, 0),
                     PLUMB_E_NULL);
    base.bytes[base.size / 2] ^= 1;
    assert_int_equal(plumb_world_restore_trusted(p.world, base.bytes, base.size), PLUMB_E_IMAGE);
    assert_int_equal(
        plumb_world_restore_frame_trusted(p.world, base.bytes, base.size, base.bytes, base.size),
        PLUMB_E_IMAGE);
    free(base.bytes);
    plumb_world_destroy(p.world);
}

//---- memory --------------------------------------------------------------------------------------
static void rolling_back_allocates_nothing(void **state)
{
    (void)state;
    heap h = HEAP_INIT;
    pile p;
    make_pile(&p, (plumb_world_desc){ .allocator = heap_allocator(&h) }, 10);
    image base = save(p.world), kept[12];
    for (int i = 0; i < 12; ++i) {
        kept[i] = (image){ malloc(2 * base.size), 2 * base.size };
    }
    long warm = 0;
    for (int round = 0; round < 40; ++round) {
        warm = round == 8 ? h.calls : warm;
        for (int i = 0; i < 12; ++i) {
            assert_int_equal(plumb_world_save_frame(p.world, base.bytes, base.size, kept[i].bytes,
                                                    2 * base.size, &kept[i].size),
                             PLUMB_OK);
            step(p.world, 1);
        }
        int to = round % 12;
        assert_int_equal(plumb_world_restore_frame(p.world, base.bytes, base.size, kept[to].bytes,
                                                   kept[to].size),
                         PLUMB_OK);
        step(p.world, 12 - to);
        assert_int_equal(plumb_world_restore_frame_trusted(p.world, base.bytes, base.size,
                                                           kept[0].bytes, kept[0].size),
                         PLUMB_OK);
    }
    assert_int_equal(plumb_world_restore_trusted(p.world, base.bytes, base.size), PLUMB_OK);
    assert_int_equal(h.calls, warm);
    for (int i = 0; i < 12; ++i) {
        free(kept[i].bytes);
    }
    free(base.bytes);
    plumb_world_destroy(p.world);
}

static void out_of_memory_leaves_the_world_as_it_was(void **state)
{
    (void)state;
    pile p;
    make_pile(&p, (plumb_world_desc){ 0 }, 30);
    image i = save(p.world);
    int refused = 0;
    for (long k = 0;; ++k) {
        heap h = HEAP_INIT;
        plumb_world *w = NULL;
        assert_int_equal(
            plumb_world_create(&(plumb_world_desc){ .allocator = heap_allocator(&h) }, &w),
            PLUMB_OK);
        plumb_component_create(w, &(plumb_component_desc){ .name = "tag", .size = 8 });
        plumb_body_create(w, &(plumb_body_desc){ 0 });
        step(w, 2);
        uint64_t hash = plumb_world_hash(w);
        heap_fail(&h, k);
        plumb_result r = plumb_world_restore(w, i.bytes, i.size);
        if (r == PLUMB_E_MEMORY) {
            ++refused;
            assert_true(plumb_world_hash(w) == hash);
            r = plumb_world_restore(w, i.bytes, i.size);
            assert_int_equal(r, PLUMB_OK);
        } else {
            assert_int_equal(r, PLUMB_OK);
        }
        assert_true(plumb_world_hash(w) == plumb_world_hash(p.world));
        bool all = h.refused == 0;
        plumb_world_destroy(w);
        if (all) {
            break;
        }
    }
    assert_in_range(refused, 5, 100);
    free(i.bytes);
    plumb_world_destroy(p.world);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(damage_is_refused_whole),
        cmocka_unit_test(damaged_deltas_are_refused),
        API_TEST(refusals_say_why),
        API_TEST(a_stepping_world_is_locked),
        cmocka_unit_test(trusted_images_are_verified_too),
        cmocka_unit_test(rolling_back_allocates_nothing),
        cmocka_unit_test(out_of_memory_leaves_the_world_as_it_was),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

// fuzz_image.c - forged images, frames and deltas, with checksums that are right: refused with the world as it was,
// or taken; and then the world steps, answers and can be saved.
//
// An input is a byte that says which world and what is forged, then changes: a section, a place in it, what comes
// there (forge.h).
#include "fuzz/forge.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

typedef struct image {
    char *bytes;
    size_t size;
} image;

static image save(const plumb_world *w)
{
    image i = { .size = plumb_world_snapshot_size(w) };
    i.bytes = malloc(i.size);
    need(i.bytes != NULL && plumb_world_save(w, i.bytes, i.size) == PLUMB_OK);
    return i;
}

typedef struct original {
    image image, later, frame, delta; // of one world, some steps apart
} original;

static original *original_of(int which)
{
    static original all[WORLDS];
    original *o = &all[which];
    if (o->image.bytes == NULL) {
        plumb_world *w = make_world(which, which == 1 ? 12 : 6);
        o->image = save(w);
        plumb_world_step(w, R(1.0 / 60));
        o->later = save(w);
        o->frame.bytes = malloc(o->later.size);
        need(o->frame.bytes != NULL &&
             plumb_world_save_frame(w, o->image.bytes, o->image.size, o->frame.bytes, o->later.size,
                                    &o->frame.size) == PLUMB_OK);
        o->delta.size = plumb_snapshot_delta_bound(o->later.size);
        o->delta.bytes = malloc(o->delta.size);
        need(o->delta.bytes != NULL &&
             plumb_snapshot_delta(o->image.bytes, o->image.size, o->later.bytes, o->later.size,
                                  o->delta.bytes, o->delta.size, &o->delta.size) == PLUMB_OK);
        plumb_world_destroy(w);
    }
    return o;
}

static image copy_of(const image *from)
{
    image i = { malloc(from->size), from->size };
    need(i.bytes != NULL);
    memcpy(i.bytes, from->bytes, from->size);
    return i;
}

// A change in some section of an image: they differ much in size.
static void change_image(script *s, image *i)
{
    pl_image view;
    const uint32_t which = byte_of(s), place = word_of(s);
    if (!pl_image_view(i->bytes, i->size, &view) || which >= 252) {
        change(s, i->bytes, i->size, place); // anywhere, header and directory too
        return;
    }
    pl_image_cursor at = pl_image_begin(&view);
    for (uint64_t k = 0; k <= which % view.header.section_count; ++k) {
        pl_image_next(&view, &at);
    }
    change(s, (char *)at.data, (size_t)at.entry.count * at.entry.stride, place);
}

static void mend_delta(image *d)
{
    struct {
        uint64_t magic, version, bytes, checksum, from, to, to_bytes;
    } h;
    memcpy(&h, d->bytes, sizeof h);
    if (h.bytes >= sizeof h && h.bytes <= d->size) {
        h.checksum = pl_digest_sealed(&h, sizeof h, 24, d->bytes + sizeof h, h.bytes - sizeof h);
        memcpy(d->bytes, &h, sizeof h);
    }
}

static plumb_result forge_image(script *s, const original *o, plumb_world *w)
{
    image i = copy_of(&o->image);
    while (s->at < s->end) {
        change_image(s, &i);
    }
    mend_image(i.bytes, i.size);
    plumb_result r = plumb_world_restore(w, i.bytes, i.size);
    free(i.bytes);
    return r;
}

static plumb_result forge_frame(script *s, const original *o, plumb_world *w)
{
    image i = copy_of(&o->frame);
    while (s->at < s->end) {
        change_image(s, &i);
    }
    mend_image(i.bytes, i.size);
    plumb_result r = plumb_world_restore_frame(w, o->image.bytes, o->image.size, i.bytes, i.size);
    free(i.bytes);
    return r;
}

static plumb_result forge_delta(script *s, const original *o, plumb_world *w)
{
    image d = copy_of(&o->delta);
    const size_t room = 2 * o->later.size;
    while (s->at < s->end) {
        uint32_t place = word_of(s);
        change(s, d.bytes, d.size, place);
    }
    mend_delta(&d);
    pl_image from, to;
    char *bytes = malloc(room);
    need(bytes != NULL && pl_image_view(o->image.bytes, o->image.size, &from));
    plumb_result r = PLUMB_E_IMAGE;
    if (pl_delta_result_bytes(d.bytes, d.size) <= room &&
        pl_delta_apply(&from, d.bytes, d.size, bytes, &to)) {
        mend_image(bytes, (size_t)to.header.bytes);
        r = plumb_world_restore(w, bytes, (size_t)to.header.bytes);
    }
    free(bytes);
    free(d.bytes);
    return r;
}

// A world that took nothing so far: making one costs more than refusing an image.
static plumb_world *clean[WORLDS];

static plumb_world *take_clean(int which)
{
    plumb_world *w = clean[which];
    clean[which] = NULL;
    return w != NULL ? w : which == 3 ? make_world(3, 0) : make_empty();
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    script s = { data, data + (size < 256 ? size : 256) };
    const uint32_t first = byte_of(&s);
    const int which = (int)(first % WORLDS), what = (int)(first / WORLDS % 8);
    const original *o = original_of(which);
    plumb_world *w = take_clean(which);
    const bool compares = first >= 224; // costs as much as all the rest
    const uint64_t before = compares ? plumb_world_hash(w) : 0;
    plumb_result r = what < 6    ? forge_image(&s, o, w)
                     : what == 6 ? forge_frame(&s, o, w)
                                 : forge_delta(&s, o, w);
    if (r != PLUMB_OK) {
        need(!compares || plumb_world_hash(w) == before);
        clean[which] = w;
        return 0;
    }
    live(w);
    plumb_world_destroy(w);
    return 0;
}

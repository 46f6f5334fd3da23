// beams.c - beams of light: a bright core in a halo of the same colour, the wider and the denser the brighter.
//
// A picture has a light ground, on which light that is added would not be seen: halos cover instead, in layers whose
// cover adds up towards the core. Brightness goes by the root, so that the fifth reflection is still seen.
#include "internal.h"

#include <math.h>

static const render_rgba laser = { 0xe5, 0x2f, 0x2a, 0xff };

// Widths [px] at full brightness, times ui scale, and cover of the layers, from the outside in.
static const struct layer {
    double width, cover;
    double pale; // share of white
} layers[] = {
    { 13.0, 0.07, 0 }, { 8.0, 0.11, 0 }, { 4.6, 0.22, 0 }, { 2.4, 0.85, 0 }, { 1.0, 0.7, 0.6 }
};

static void draw_beam(plr_painter *painter, const plr_mark *mark, const struct layer *layer)
{
    const render_rgba white = { 0xff, 0xff, 0xff, 0xff };
    render_rgba color = mark->color.a > 0 ? mark->color : laser;
    color.a = 0xff;
    const double a = sqrt(mark->bright_a), b = sqrt(mark->bright_b);
    const double width = layer->width * painter->ui * (0.35 + 0.65 * fmax(a, b));
    const render_rgba hue = plr_mix(color, white, layer->pale);
    const render_vec ends[2] = { plr_pixel(painter, mark->a), plr_pixel(painter, mark->b) };
    if (hypot(ends[1].x - ends[0].x, ends[1].y - ends[0].y) > 1e-3) {
        plr_stroke(painter, ends, 2, false, width, plr_fade(hue, layer->cover * a),
                   plr_fade(hue, layer->cover * b));
    }
}

void plr_draw_beams(plr_painter *painter)
{
    const render_frame *frame = painter->frame;
    if (frame->mark_kind_count[PLR_BEAM] == 0) {
        return;
    }
    // Layer by layer: no halo lies on the core of another beam.
    for (size_t k = 0; k < sizeof layers / sizeof *layers; k++) {
        for (size_t i = 0; i < frame->mark_count; i++) {
            if (frame->marks[i].kind == PLR_BEAM) {
                draw_beam(painter, &frame->marks[i], &layers[k]);
            }
        }
    }
}

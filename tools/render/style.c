// style.c - colours: the palette, what a body's class makes of it, mixing.
//
// The ten hues keep their distance under the common kinds of colour blindness by differing in
// lightness as well as in hue; they are muted so that overlays in full colours stand out.
#include "internal.h"

const render_rgba plr_ink = { 0x33, 0x31, 0x2e, 0xff };
const render_rgba plr_background = { 0xfb, 0xf8, 0xf2, 0xff };

static const render_rgba palette[RENDER_PALETTE_COUNT] = {
    { 0x5b, 0x8f, 0xbf, 0xff }, // blue
    { 0xea, 0xa2, 0x4f, 0xff }, // orange
    { 0x74, 0xb0, 0x83, 0xff }, // green
    { 0xcf, 0x6e, 0x73, 0xff }, // red
    { 0x9b, 0x86, 0xbd, 0xff }, // violet
    { 0x4d, 0xa5, 0xa3, 0xff }, // teal
    { 0xe9, 0xca, 0x6b, 0xff }, // yellow
    { 0xa8, 0x82, 0x66, 0xff }, // brown
    { 0x9c, 0xc7, 0xe6, 0xff }, // sky
    { 0xe6, 0xad, 0xbd, 0xff }, // pink
};

static const render_rgba static_fill = { 0xcb, 0xc7, 0xbf, 0xff };
static const render_rgba black = { 0x1c, 0x1a, 0x22, 0xff };

// Shares chosen by eye on the sample scenes: the outline must separate equal neighbours without
// turning the picture into a drawing of lines.
static const double outline_darkness = 0.42;
static const double hatch_darkness = 0.16;
static const double stripe_lightness = 0.30;
static const double asleep_fading = 0.62;
static const double sensor_alpha = 0.16;
static const double fluid_alpha = 0.36;
static const double glass_alpha = 0.42;
static const render_rgba glass = { 0x9f, 0xcb, 0xdd, 0xff };
static const render_rgba water = { 0x4a, 0x9a, 0xd8, 0xff };

render_rgba render_palette(int index)
{
    const int wrapped = index % RENDER_PALETTE_COUNT;
    return palette[wrapped < 0 ? wrapped + RENDER_PALETTE_COUNT : wrapped];
}

static uint8_t mix8(uint8_t a, uint8_t b, double t)
{
    return (uint8_t)(a + (b - a) * t + 0.5);
}

render_rgba plr_mix(render_rgba a, render_rgba b, double t)
{
    return (render_rgba){ mix8(a.r, b.r, t), mix8(a.g, b.g, t), mix8(a.b, b.b, t),
                          mix8(a.a, b.a, t) };
}

render_rgba plr_fade(render_rgba color, double alpha)
{
    color.a = (uint8_t)(color.a * alpha + 0.5);
    return color;
}

static render_rgba opaque(render_rgba color)
{
    color.a = 0xff;
    return color;
}

plr_paint plr_body_paint(const plr_body *body, render_rgba background)
{
    const render_rgba hue = body->color.a > 0 ? body->color : render_palette(body->palette);
    plr_paint paint = { .fill = hue };
    switch (body->kind) {
    case RENDER_STATIC:
        paint.fill = body->color.a > 0 ? body->color : static_fill;
        paint.hatch = plr_mix(opaque(paint.fill), black, hatch_darkness);
        break;
    case RENDER_KINEMATIC:
        paint.hatch = plr_mix(opaque(hue), background, stripe_lightness);
        break;
    case RENDER_ASLEEP:
        paint.fill = plr_mix(hue, background, asleep_fading);
        paint.outline = plr_mix(opaque(hue), background, 0.5 * asleep_fading);
        return paint;
    case RENDER_SENSOR:
        paint.outline = plr_mix(opaque(hue), black, 0.5 * outline_darkness);
        paint.fill = plr_fade(hue, sensor_alpha);
        paint.dashed = true;
        return paint;
    case RENDER_GLASS:
        paint.fill = body->color.a > 0 ? body->color : glass;
        paint.outline = plr_mix(opaque(paint.fill), black, 0.6 * outline_darkness);
        paint.fill = plr_fade(paint.fill, glass_alpha);
        return paint;
    case RENDER_FLUID:
        paint.fill = body->color.a > 0 ? body->color : water;
        paint.outline = plr_mix(opaque(paint.fill), black, 0.5 * outline_darkness);
        paint.fill = plr_fade(paint.fill, fluid_alpha);
        paint.plain = true;
        return paint;
    case RENDER_DYNAMIC:
    case RENDER_CLASS_COUNT:
        break;
    }
    paint.outline = plr_mix(opaque(paint.fill), black, outline_darkness);
    return paint;
}

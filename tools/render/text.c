// text.c - legible text: FreeType glyphs in an atlas, with a halo of the same shape.
//
// Glyphs are rasterised when first needed, per font, size and halo, packed in shelves into a
// square atlas of coverage values and drawn as quads at whole pixels, so that hinting survives.
// When the atlas or the table is full, missing glyphs are left out of that frame and the atlas is
// emptied before the next. Cost: one table look-up and four vertices a letter.
#include "internal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <ft2build.h>
#include FT_FREETYPE_H
#include FT_GLYPH_H
#include FT_STROKER_H

enum {
    atlas_size = 1024,
    table_size = 4096, // power of two; a picture uses about 200 glyphs
    table_full = table_size * 3 / 4,
    gap = 1 // free pixels between glyphs
};

// Halo around the letters as a share of the font size.
static const double halo_share = 0.16;

// Usual places of DejaVu Sans and of Liberation Sans; the first is that of Debian's package.
static const char *const font_paths[] = {
    "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf",
    "/usr/share/fonts/dejavu-sans-fonts/DejaVuSans.ttf",
    "/usr/share/fonts/TTF/DejaVuSans.ttf",
    "/usr/share/fonts/dejavu/DejaVuSans.ttf",
    "/usr/local/share/fonts/dejavu/DejaVuSans.ttf",
    "/usr/share/fonts/truetype/liberation/LiberationSans-Regular.ttf",
    "/usr/share/fonts/truetype/liberation2/LiberationSans-Regular.ttf",
};

typedef struct glyph {
    uint64_t key; // 0 = free slot
    int x, y, width, height;
    int left, top; // of the bitmap relative to the pen on the baseline
    double advance;
} glyph;

struct plr_text {
    render_allocator allocator;
    FT_Library library;
    FT_Face faces[PLR_FONT_COUNT];
    int face_size[PLR_FONT_COUNT]; // size set last
    FT_Stroker stroker;
    uint8_t *atlas;
    glyph *table;
    size_t table_count;
    int shelf_x, shelf_y, shelf_height;
    unsigned version;
    bool overfull;
};

// ---- fonts

static bool open_face(plr_text *text, plr_font font, const char *path)
{
    return FT_New_Face(text->library, path, 0, &text->faces[font]) == 0;
}

// The bold file of the same family: "X.ttf" -> "X-Bold.ttf", "X-Regular.ttf" -> "X-Bold.ttf".
static void open_bold_sibling(plr_text *text, const char *regular)
{
    char path[1024];
    const char *dot = strrchr(regular, '.');
    size_t stem = dot != NULL ? (size_t)(dot - regular) : 0;
    const char *suffix = "-Regular";
    const size_t suffix_length = strlen(suffix);
    if (stem > suffix_length &&
        memcmp(regular + stem - suffix_length, suffix, suffix_length) == 0) {
        stem -= suffix_length;
    }
    const char *bold = "-Bold";
    if (dot == NULL || stem + strlen(bold) + strlen(dot) + 1 > sizeof path) {
        return;
    }
    memcpy(path, regular, stem);
    memcpy(path + stem, bold, strlen(bold));
    memcpy(path + stem + strlen(bold), dot, strlen(dot) + 1);
    open_face(text, PLR_FONT_BOLD, path);
}

static render_result open_fonts(plr_text *text, const render_target_desc *desc, render_error *error)
{
    const char *regular = desc->font_path != NULL ? desc->font_path : getenv("PLUMB_FONT");
    if (regular != NULL && regular[0] != '\0') {
        if (!open_face(text, PLR_FONT_REGULAR, regular)) {
            return plr_fail(error, RENDER_E_FONT, "cannot read the font file '%s'", regular);
        }
    } else {
        const size_t count = sizeof font_paths / sizeof font_paths[0];
        size_t i = 0;
        while (i < count && !open_face(text, PLR_FONT_REGULAR, font_paths[i])) {
            i++;
        }
        if (i == count) {
            return plr_fail(error, RENDER_E_FONT,
                            "no font found: install the package fonts-dejavu-core, or name a "
                            "TrueType file in the environment variable PLUMB_FONT");
        }
        regular = font_paths[i];
    }
    if (desc->bold_font_path != NULL) {
        if (!open_face(text, PLR_FONT_BOLD, desc->bold_font_path)) {
            return plr_fail(error, RENDER_E_FONT, "cannot read the font file '%s'",
                            desc->bold_font_path);
        }
    } else {
        open_bold_sibling(text, regular);
    }
    return RENDER_OK;
}

render_result plr_text_create(plr_text **out, const render_target_desc *desc,
                              const render_allocator *allocator, render_error *error)
{
    *out = NULL;
    plr_text *text = allocator->resize(allocator->user, NULL, 0, sizeof *text);
    if (text == NULL) {
        return plr_fail(error, RENDER_E_MEMORY, "out of memory");
    }
    *text = (plr_text){ .allocator = *allocator, .version = 1 };
    text->atlas = allocator->resize(allocator->user, NULL, 0, atlas_size * atlas_size);
    text->table = allocator->resize(allocator->user, NULL, 0, table_size * sizeof(glyph));
    if (text->atlas == NULL || text->table == NULL || FT_Init_FreeType(&text->library) != 0 ||
        FT_Stroker_New(text->library, &text->stroker) != 0) {
        plr_text_destroy(text);
        return plr_fail(error, RENDER_E_MEMORY, "out of memory");
    }
    memset(text->atlas, 0, atlas_size * atlas_size);
    memset(text->table, 0, table_size * sizeof(glyph));
    const render_result result = open_fonts(text, desc, error);
    if (result != RENDER_OK) {
        plr_text_destroy(text);
        return result;
    }
    *out = text;
    return RENDER_OK;
}

void plr_text_destroy(plr_text *text)
{
    if (text == NULL) {
        return;
    }
    if (text->stroker != NULL) {
        FT_Stroker_Done(text->stroker);
    }
    if (text->library != NULL) {
        FT_Done_FreeType(text->library); // closes the faces too
    }
    const render_allocator memory = text->allocator;
    plr_release(&memory, text->atlas, atlas_size * atlas_size, 1);
    plr_release(&memory, text->table, table_size, sizeof(glyph));
    plr_release(&memory, text, 1, sizeof *text);
}

void plr_text_begin(plr_text *text)
{
    if (!text->overfull) {
        return;
    }
    memset(text->atlas, 0, atlas_size * atlas_size);
    memset(text->table, 0, table_size * sizeof(glyph));
    text->table_count = 0;
    text->shelf_x = text->shelf_y = text->shelf_height = 0;
    text->overfull = false;
    text->version++;
}

void plr_text_end(plr_text *text, plr_batch *batch)
{
    batch->atlas = text->atlas;
    batch->atlas_size = atlas_size;
    batch->atlas_version = text->version;
}

// ---- glyphs

static FT_Face face_of(plr_text *text, plr_font *font, int size)
{
    if (text->faces[*font] == NULL) {
        *font = PLR_FONT_REGULAR;
    }
    if (text->face_size[*font] != size) {
        FT_Set_Pixel_Sizes(text->faces[*font], 0, (FT_UInt)size);
        text->face_size[*font] = size;
    }
    return text->faces[*font];
}

// Finds room for a bitmap in the atlas.
static bool place(plr_text *text, glyph *g)
{
    if (text->shelf_x + g->width + gap > atlas_size) {
        text->shelf_y += text->shelf_height;
        text->shelf_x = 0;
        text->shelf_height = 0;
    }
    if (g->width + gap > atlas_size || text->shelf_y + g->height + gap > atlas_size) {
        return false;
    }
    g->x = text->shelf_x;
    g->y = text->shelf_y;
    text->shelf_x += g->width + gap;
    if (g->height + gap > text->shelf_height) {
        text->shelf_height = g->height + gap;
    }
    return true;
}

static bool rasterise(plr_text *text, FT_Face face, int size, bool halo, glyph *g)
{
    FT_Glyph outline;
    if (FT_Get_Glyph(face->glyph, &outline) != 0) {
        return false;
    }
    if (halo) {
        const double radius = fmax(1.0, halo_share * size);
        FT_Stroker_Set(text->stroker, (FT_Fixed)(radius * 64.0), FT_STROKER_LINECAP_ROUND,
                       FT_STROKER_LINEJOIN_ROUND, 0);
        FT_Glyph_StrokeBorder(&outline, text->stroker, 0, 1);
    }
    bool done = false;
    if (FT_Glyph_To_Bitmap(&outline, FT_RENDER_MODE_NORMAL, NULL, 1) == 0) {
        const FT_BitmapGlyph bitmap = (FT_BitmapGlyph)outline;
        g->width = (int)bitmap->bitmap.width;
        g->height = (int)bitmap->bitmap.rows;
        g->left = bitmap->left;
        g->top = bitmap->top;
        done = place(text, g);
        for (int row = 0; done && row < g->height; row++) {
            memcpy(text->atlas + (size_t)(g->y + row) * atlas_size + g->x,
                   bitmap->bitmap.buffer + (ptrdiff_t)row * bitmap->bitmap.pitch, (size_t)g->width);
        }
    }
    FT_Done_Glyph(outline);
    return done;
}

// The glyph of a character; NULL when it cannot be had in this frame.
static const glyph *find_glyph(plr_text *text, plr_font font, int size, bool halo, uint32_t code)
{
    FT_Face face = face_of(text, &font, size);
    const uint64_t key = ((uint64_t)code << 32) | ((uint64_t)size << 8) | ((uint64_t)font << 2) |
                         (halo ? 2u : 0u) | 1u;
    size_t slot = (size_t)((key * 0x9e3779b97f4a7c15u) >> 40) & (table_size - 1);
    while (text->table[slot].key != 0) {
        if (text->table[slot].key == key) {
            return &text->table[slot];
        }
        slot = (slot + 1) & (table_size - 1);
    }
    if (text->table_count >= table_full) {
        text->overfull = true;
        return NULL;
    }
    if (FT_Load_Char(face, code, FT_LOAD_TARGET_LIGHT | FT_LOAD_NO_BITMAP) != 0) {
        return NULL;
    }
    glyph g = { .key = key, .advance = round((double)face->glyph->advance.x / 64.0) };
    if (!rasterise(text, face, size, halo, &g)) {
        text->overfull = true;
        return NULL;
    }
    text->version++;
    text->table_count++;
    text->table[slot] = g;
    return &text->table[slot];
}

// Decodes one character of UTF-8; a malformed byte becomes U+FFFD.
static uint32_t next_code(const char **string)
{
    const unsigned char *s = (const unsigned char *)*string;
    const uint32_t lead = s[0];
    const int extra = lead < 0x80   ? 0
                      : lead < 0xc2 ? -1
                      : lead < 0xe0 ? 1
                      : lead < 0xf0 ? 2
                      : lead < 0xf5 ? 3
                                    : -1;
    uint32_t code = extra > 0 ? lead & (0x3fu >> extra) : lead;
    for (int i = 1; i <= extra; i++) {
        if ((s[i] & 0xc0u) != 0x80u) {
            *string += 1;
            return 0xfffd;
        }
        code = (code << 6) | (s[i] & 0x3fu);
    }
    *string += 1 + (extra > 0 ? extra : 0);
    return extra < 0 ? 0xfffd : code;
}

// ---- use

double plr_text_width(plr_text *text, plr_font font, int size, const char *string)
{
    double width = 0.0;
    while (*string != '\0') {
        const glyph *g = find_glyph(text, font, size, false, next_code(&string));
        width += g != NULL ? g->advance : 0.0;
    }
    return width;
}

static void draw_pass(plr_painter *painter, plr_font font, int size, render_vec at,
                      const char *string, render_rgba color, bool halo)
{
    double x = round(at.x);
    const double y = round(at.y);
    while (*string != '\0') {
        const glyph *g = find_glyph(painter->text, font, size, halo, next_code(&string));
        if (g == NULL) {
            continue;
        }
        if (g->width > 0) {
            const double left = x + g->left, top = y - g->top;
            const double rect[4] = { left, top, left + g->width, top + g->height };
            const double s = 1.0 / atlas_size;
            const double uv[4] = { g->x * s, g->y * s, (g->x + g->width) * s,
                                   (g->y + g->height) * s };
            plr_batch_glyph(painter->batch, rect, uv, color);
        }
        x += g->advance;
    }
}

void plr_text_draw(plr_painter *painter, plr_font font, int size, render_vec at, const char *string,
                   render_rgba color, render_rgba halo)
{
    if (halo.a > 0) {
        draw_pass(painter, font, size, at, string, halo, true);
    }
    draw_pass(painter, font, size, at, string, color, false);
}

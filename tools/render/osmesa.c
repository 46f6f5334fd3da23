// osmesa.c - the backend that draws batches with OSMesa, Mesa's off-screen OpenGL.
//
// Needs no display and no GPU. OSMesa writes the picture into the buffer of this file when the
// context is finished. Only OpenGL 1.x of the compatibility profile is used: vertex arrays, one
// texture, blending. Cost: Mesa's rasteriser; the first draw compiles it (up to 0.1 s).
// Newer versions of Mesa come without OSMesa; another backend is one more file with a plr_backend.
#include "internal.h"

#include <GL/gl.h>
#include <GL/osmesa.h>

typedef struct osmesa_state {
    render_allocator allocator;
    OSMesaContext context;
    uint8_t *buffer;
    int width, height;
    GLuint texture;
    unsigned atlas_version; // of the texture's content; 0 = none yet
} osmesa_state;

static size_t buffer_size(const osmesa_state *state)
{
    return (size_t)state->width * (size_t)state->height * 4;
}

static void osmesa_destroy(void *opaque)
{
    osmesa_state *state = opaque;
    if (state == NULL) {
        return;
    }
    if (state->context != NULL) {
        OSMesaDestroyContext(state->context);
    }
    const render_allocator memory = state->allocator;
    plr_release(&memory, state->buffer, buffer_size(state), 1);
    plr_release(&memory, state, 1, sizeof *state);
}

static bool make_current(osmesa_state *state)
{
    if (!OSMesaMakeCurrent(state->context, state->buffer, GL_UNSIGNED_BYTE, state->width,
                           state->height)) {
        return false;
    }
    OSMesaPixelStore(OSMESA_Y_UP, 0); // top row first
    return true;
}

static render_result osmesa_create(void **out, int width, int height,
                                   const render_allocator *allocator, render_error *error)
{
    *out = NULL;
    osmesa_state *state = allocator->resize(allocator->user, NULL, 0, sizeof *state);
    if (state == NULL) {
        return plr_fail(error, RENDER_E_MEMORY, "out of memory");
    }
    *state = (osmesa_state){ .allocator = *allocator, .width = width, .height = height };
    state->buffer = allocator->resize(allocator->user, NULL, 0, buffer_size(state));
    if (state->buffer == NULL) {
        osmesa_destroy(state);
        return plr_fail(error, RENDER_E_MEMORY, "out of memory for a picture of %d x %d", width,
                        height);
    }
    const int attributes[] = { OSMESA_FORMAT,         OSMESA_RGBA, OSMESA_PROFILE,
                               OSMESA_COMPAT_PROFILE, 0,           0 };
    state->context = OSMesaCreateContextAttribs(attributes, NULL);
    if (state->context == NULL || !make_current(state)) {
        osmesa_destroy(state);
        return plr_fail(error, RENDER_E_BACKEND, "OSMesa cannot make an OpenGL context of %d x %d",
                        width, height);
    }
    *out = state;
    return RENDER_OK;
}

static void set_state(const osmesa_state *state, render_rgba background)
{
    glViewport(0, 0, state->width, state->height);
    glMatrixMode(GL_PROJECTION);
    glLoadIdentity();
    glOrtho(0.0, state->width, state->height, 0.0, -1.0, 1.0);
    glMatrixMode(GL_MODELVIEW);
    glLoadIdentity();
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_CULL_FACE);
    glDisable(GL_DITHER);
    glShadeModel(GL_SMOOTH);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glClearColor((float)background.r / 255.0f, (float)background.g / 255.0f,
                 (float)background.b / 255.0f, 1.0f);
    glClear(GL_COLOR_BUFFER_BIT);
    // The picture stays opaque: alpha is cleared to one and not written any more.
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_FALSE);
    glEnable(GL_BLEND);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
}

static void update_texture(osmesa_state *state, const plr_batch *batch)
{
    if (state->texture == 0) {
        glGenTextures(1, &state->texture);
    }
    glBindTexture(GL_TEXTURE_2D, state->texture);
    if (state->atlas_version == batch->atlas_version) {
        return;
    }
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glTexEnvi(GL_TEXTURE_ENV, GL_TEXTURE_ENV_MODE, GL_MODULATE);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_ALPHA, batch->atlas_size, batch->atlas_size, 0, GL_ALPHA,
                 GL_UNSIGNED_BYTE, batch->atlas);
    state->atlas_version = batch->atlas_version;
}

static void draw_runs(const plr_batch *batch)
{
    const GLsizei stride = (GLsizei)sizeof(plr_vertex);
    glEnableClientState(GL_VERTEX_ARRAY);
    glEnableClientState(GL_TEXTURE_COORD_ARRAY);
    glEnableClientState(GL_COLOR_ARRAY);
    glVertexPointer(2, GL_FLOAT, stride, &batch->vertices->x);
    glTexCoordPointer(2, GL_FLOAT, stride, &batch->vertices->u);
    glColorPointer(4, GL_UNSIGNED_BYTE, stride, &batch->vertices->color);
    for (size_t i = 0; i < batch->run_count; i++) {
        const plr_run *run = &batch->runs[i];
        if (run->textured) {
            glEnable(GL_TEXTURE_2D);
        } else {
            glDisable(GL_TEXTURE_2D);
        }
        glDrawElements(GL_TRIANGLES, (GLsizei)run->count, GL_UNSIGNED_INT,
                       batch->indices + run->first);
    }
}

static render_result osmesa_submit(void *opaque, const plr_batch *batch, render_error *error)
{
    osmesa_state *state = opaque;
    if (!make_current(state)) {
        return plr_fail(error, RENDER_E_BACKEND, "OSMesa cannot use its OpenGL context");
    }
    set_state(state, batch->background);
    if (batch->index_count > 0) {
        update_texture(state, batch);
        draw_runs(batch);
    }
    glFinish();
    const GLenum code = glGetError();
    if (code != GL_NO_ERROR) {
        return plr_fail(error, RENDER_E_BACKEND, "OpenGL error 0x%04x while drawing",
                        (unsigned)code);
    }
    return RENDER_OK;
}

static const uint8_t *osmesa_pixels(const void *opaque)
{
    return ((const osmesa_state *)opaque)->buffer;
}

const plr_backend plr_backend_osmesa = {
    .name = "OSMesa",
    .create = osmesa_create,
    .submit = osmesa_submit,
    .pixels = osmesa_pixels,
    .destroy = osmesa_destroy,
};

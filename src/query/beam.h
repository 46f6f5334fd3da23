// beam.h - a ray of light under way: what it meets next, what is behind a surface.
#ifndef PL_BEAM_H
#define PL_BEAM_H

#include "query/query.h"

// Where a beam starts from a surface, and on which side of it it goes on.
typedef enum pl_beam_side {
    PL_BEAM_FREE,   // it starts in the open
    PL_BEAM_INWARD, // into the piece: that is left, wherever rounding has put the start
    PL_BEAM_OUTWARD // away from the piece: what is convex is not met twice
} pl_beam_side;

// A medium is the row of a material; PL_NONE is what is around all shapes.
typedef struct pl_beam {
    double x, y;     // [m] where it starts
    double dx, dy;   // unit
    double length;   // [m] of way that is left
    double power[2]; // [W] across the plane of the world, within it
    uint32_t medium; // it runs in
    uint32_t piece;  // it comes from
    pl_beam_side side;
    int parent, depth, how;
} pl_beam;

// Lines come before solids, what stops before what lets pass, as they are met in one place.
typedef enum pl_beam_event_kind {
    PL_BEAM_LINE,
    PL_BEAM_OPAQUE,
    PL_BEAM_ENTERS,
    PL_BEAM_LEAVES
} pl_beam_event_kind;

typedef struct pl_beam_event {
    double at;     // [m] along the beam
    double nx, ny; // unit, against the beam; 0: it starts in the piece, which is opaque
    pl_beam_event_kind kind;
    uint32_t slot, piece; // of the shape; PL_NONE: nothing
} pl_beam_event;

// What a piece is made of.
static inline bool pl_beam_passes(const plumb_world *world, uint32_t piece)
{
    return world->materials.refractive_index[world->pieces.material[piece]] > 0;
}

// The first event behind `last` (kind PL_BEAM_LINE at a place below 0: from the start); piece PL_NONE where there is none.
pl_beam_event pl_beam_next(pl_query *q, const pl_beam *beam, const pl_beam_event *last);

// What is at a place [m]: the opaque piece that holds it, else the medium. The piece `event` tells of counts as inside
// where the beam enters it, as outside where it leaves it; NULL: there is none such.
typedef struct pl_beam_place {
    uint32_t opaque; // a piece; PL_NONE: none
    uint32_t medium;
} pl_beam_place;
pl_beam_place pl_beam_look(pl_query *q, double x, double y, const pl_beam_event *event);

// [m] below which gaps between shapes are none, near such coordinates.
double pl_beam_gap(double x, double y);

#endif

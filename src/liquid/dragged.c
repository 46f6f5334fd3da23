// dragged.c - bodies in the system of viscosity: three columns a body, which its links add to the faces that it closes, as in
// links.c. What walls take from the flow is then what bodies get.
//
// Reads: links, stresses. Writes: bodies of the grid. Cost: O(bodies + links) a product.
#include "liquid/viscous.h"

#include <string.h>

// How much of a face is closed, if it goes with what closes it: then its link counts, else the face is unknown itself.
static near_real shut_of(const pl_viscous *s, const pl_liquid_link *link)
{
    return (link->upright ? s->shut.v : s->shut.u)[link->cell];
}

void pl_viscous_add_closed(pl_viscous *s)
{
    for (uint32_t i = 0; i < s->g->link_count; ++i) {
        const pl_liquid_link *link = &s->g->links[i];
        (link->upright ? s->shut.v : s->shut.u)[link->cell] += link->part;
    }
}

static uint32_t body_count(const pl_viscous *s)
{
    return s->bodies != NULL ? s->g->body_count : 0;
}

static uint32_t link_count(const pl_viscous *s)
{
    return s->bodies != NULL ? s->g->link_count : 0;
}

static double mass_of(double inverse, const pl_liquid_grid *g)
{
    return inverse > 0 ? 1 / (inverse * g->drag) : 0;
}

void pl_viscous_find_bodies(pl_viscous *s)
{
    for (uint32_t i = 0; i < body_count(s); ++i) {
        const pl_liquid_body *b = &s->g->bodies[i];
        s->bodies[i] =
            (pl_viscous_body){ .mass = { mass_of(b->inv_mass_x, s->g), mass_of(b->inv_mass_y, s->g),
                                         mass_of(b->inv_inertia, s->g) },
                               .now = { b->vx, b->vy, b->w } };
    }
}

void pl_viscous_find_body_diagonal(pl_viscous *s)
{
    for (uint32_t i = 0; i < body_count(s); ++i) {
        memcpy(s->bodies[i].diagonal, s->bodies[i].mass, sizeof s->bodies[i].mass);
    }
    for (uint32_t i = 0; i < link_count(s); ++i) {
        const pl_liquid_link *link = &s->g->links[i];
        double *to = s->bodies[link->body].diagonal;
        if (shut_of(s, link) > 0) {
            const near_real *whole = link->upright ? s->diagonal.v : s->diagonal.u;
            const near_real *mass = link->upright ? s->mass.v : s->mass.u;
            const double part = (double)(link->part / shut_of(s, link)), arm = (double)link->arm;
            const double more = part * part * (double)(whole[link->cell] - mass[link->cell]);
            to[link->upright ? 1 : 0] += more > 0 ? more : 0;
            to[2] += more > 0 ? more * arm * arm : 0;
        }
    }
}

void pl_viscous_carry(pl_viscous *s, const pl_viscous_faces *of)
{
    for (uint32_t i = 0; i < link_count(s); ++i) {
        const pl_liquid_link *link = &s->g->links[i];
        if (shut_of(s, link) > 0) {
            (link->upright ? of->v : of->u)[link->cell] = 0;
        }
    }
    for (uint32_t i = 0; i < link_count(s); ++i) {
        const pl_liquid_link *link = &s->g->links[i];
        if (shut_of(s, link) > 0) {
            const double *way = s->bodies[link->body].way;
            (link->upright ? of->v : of->u)[link->cell] +=
                link->part / shut_of(s, link) *
                (near_real)(way[link->upright ? 1 : 0] + way[2] * (double)link->arm);
        }
    }
}

static double pull_of(const pl_viscous *s, const pl_liquid_link *link)
{
    const uint32_t c = link->cell;
    return (double)s->k * (double)(link->part / shut_of(s, link)) *
           (double)(link->upright ? pl_viscous_pull_v(s, c) : pl_viscous_pull_u(s, c));
}

void pl_viscous_drag(pl_viscous *s, bool inert)
{
    for (uint32_t i = 0; i < body_count(s); ++i) {
        pl_viscous_body *d = &s->bodies[i];
        for (int k = 0; k < 3; ++k) {
            d->out[k] = inert ? d->mass[k] * d->way[k] : 0;
        }
    }
    for (uint32_t i = 0; i < link_count(s); ++i) {
        const pl_liquid_link *link = &s->g->links[i];
        if (shut_of(s, link) > 0) {
            const double got = -pull_of(s, link);
            double *out = s->bodies[link->body].out;
            out[link->upright ? 1 : 0] += got;
            out[2] += got * (double)link->arm;
        }
    }
    for (uint32_t i = 0; i < body_count(s); ++i) {
        for (int k = 0; k < 3; ++k) {
            s->bodies[i].out[k] = s->bodies[i].mass[k] > 0 ? s->bodies[i].out[k] : 0;
        }
    }
}

void pl_viscous_find_body_left(pl_viscous *s)
{
    pl_viscous_drag(s, false);
    for (uint32_t i = 0; i < body_count(s); ++i) {
        pl_viscous_body *d = &s->bodies[i];
        const pl_liquid_body *b = &s->g->bodies[i];
        const double before[3] = { b->vx, b->vy, b->w };
        for (int k = 0; k < 3; ++k) {
            d->left[k] = d->mass[k] * (before[k] - d->now[k]) - d->out[k];
        }
    }
}

double pl_viscous_dot_bodies(const pl_viscous *s, bool bend)
{
    double total = 0;
    for (uint32_t i = 0; i < body_count(s); ++i) {
        const pl_viscous_body *d = &s->bodies[i];
        for (int k = 0; k < 3; ++k) {
            total += bend             ? d->way[k] * d->out[k]
                     : d->mass[k] > 0 ? d->left[k] * d->left[k] / d->diagonal[k]
                                      : 0;
        }
    }
    return total;
}

void pl_viscous_go_bodies(pl_viscous *s, double alpha)
{
    for (uint32_t i = 0; i < body_count(s); ++i) {
        pl_viscous_body *d = &s->bodies[i];
        for (int k = 0; k < 3; ++k) {
            d->now[k] += alpha * d->way[k];
            d->left[k] -= alpha * d->out[k];
        }
    }
}

void pl_viscous_turn_bodies(pl_viscous *s, double beta)
{
    for (uint32_t i = 0; i < body_count(s); ++i) {
        pl_viscous_body *d = &s->bodies[i];
        for (int k = 0; k < 3; ++k) {
            d->way[k] = beta * d->way[k] + (d->mass[k] > 0 ? d->left[k] / d->diagonal[k] : 0);
        }
    }
}

void pl_viscous_keep_bodies(pl_viscous *s)
{
    for (uint32_t i = 0; i < body_count(s); ++i) {
        pl_liquid_body *b = &s->g->bodies[i];
        const pl_viscous_body *d = &s->bodies[i];
        const double push = s->g->drag;
        b->impulse_x += push * d->mass[0] * (d->now[0] - b->vx);
        b->impulse_y += push * d->mass[1] * (d->now[1] - b->vy);
        b->turn += push * d->mass[2] * (d->now[2] - b->w);
        b->vx = d->now[0], b->vy = d->now[1], b->w = d->now[2];
    }
}

void pl_viscous_push_bodies(pl_viscous *s)
{
    for (uint32_t i = 0; i < link_count(s); ++i) {
        const pl_liquid_link *link = &s->g->links[i];
        if (shut_of(s, link) > 0) {
            const double force = s->g->drag * pull_of(s, link);
            pl_liquid_push_body(&s->g->bodies[link->body], link->upright ? 0 : force,
                                link->upright ? force : 0, force * (double)link->arm);
        }
    }
}

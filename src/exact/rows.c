// rows.c - contacts and joints as scalar rows for the exact solver, and impulses back.
//
// A contact is those of the classic solver (solver.h): a normal row a point, then a tangent row a point, then rolling
// resistance; a joint is its rows as laws (joints/law.h). Sweeps that pull undo a share of overlaps and errors; those that
// relax leave speeds as the rows want them, from the same velocities: what was undone leaves no speed behind.
//
// Reads: contacts, joints, solver bodies. Writes: rows, impulses. Cost: O(rows).
#include "exact/exact.h"
#include "joints/law.h"

#include <math.h>

// Share of an overlap that a substep undoes.
#define RECOVERY 0.2

// Rounds of a solution that ask where bodies are going to be: places are rounded, more would not settle.
#define BENDS 2

// Friction that is so near to its bound does not hold.
#define ON_CONE 1e-6

// Of what may be given in a substep, what may in this sweep: as much comes behind the drift as before it.
static double share_of(const pl_exact_system *s)
{
    return s->sweep == PL_SWEEP_PULL ? 0.5 : 1;
}

//---- contacts ------------------------------------------------------------------------------------------

static double separation_now(const pl_exact_system *s, const pl_exact_item *item,
                             const pl_classic_contact *m, const pl_classic_point *p)
{
    const pl_solver_body *a = &pl_solver_bodies(&s->world->solver)[item->slot[0]];
    const pl_solver_body *b = &pl_solver_bodies(&s->world->solver)[item->slot[1]];
    return (double)p->separation + (double)m->nx * ((double)b->dx - (double)a->dx) +
           (double)m->ny * ((double)b->dy - (double)a->dy) + (double)p->rbn * (double)b->da -
           (double)p->ran * (double)a->da;
}

static bool turns(const pl_exact_system *s, const pl_exact_item *item)
{
    return item->turning != PL_NONE && s->turnings[item->turning].turns;
}

// [m/s] at which a point that is so far apart [m] may close, or has to part.
static double target_of(const pl_exact_system *s, double apart)
{
    const double rate = apart / (double)s->h, back = -RECOVERY * rate;
    const double push = (double)s->world->desc.push_speed;
    const double most = s->sweep == PL_SWEEP_RELAX ? 0 : s->recovery;
    return apart > 0 ? -rate : most * (back < push ? back : push);
}

static void fill_normal(const pl_exact_system *s, const pl_classic_contact *m,
                        const pl_classic_point *p, double apart, double kept, pl_exact_row *r)
{
    const double pull = apart < (double)m->reach ? (double)m->pull * share_of(s) : 0;
    *r = (pl_exact_row){ .j = { -(double)m->nx, -(double)m->ny, -(double)p->ran, (double)m->nx,
                                (double)m->ny, (double)p->rbn },
                         .target = target_of(s, apart),
                         .undone = apart < 0 ? target_of(s, apart) : 0,
                         .low = -pull - kept,
                         .high = (double)PL_UNBOUNDED,
                         .kept = kept,
                         .impulse = (double)p->ln - kept };
}

static void fill_tangent(const pl_classic_contact *m, const pl_classic_point *p, uint32_t lead,
                         double kept, pl_exact_row *r)
{
    *r = (pl_exact_row){ .j = { (double)m->ny, -(double)m->nx, -(double)p->rat, -(double)m->ny,
                                (double)m->nx, (double)p->rbt },
                         .target = -(double)m->surface_speed,
                         .low = -kept,
                         .factor = (double)m->friction,
                         .lead = lead,
                         .leads = 1,
                         .cone = true,
                         .kept = kept,
                         .impulse = (double)p->lt - kept };
}

static void fill_contact(const pl_exact_system *s, const pl_exact_item *item)
{
    pl_classic_contact *m = pl_exact_contact(s, item);
    pl_exact_row *r = s->rows + item->first_row;
    const bool stays = s->sweep == PL_SWEEP_RELAX && r->stays;
    const double share = stays ? 1 : 0;
    if (s->first && s->sweep == PL_SWEEP_PULL && item->turning != PL_NONE) {
        pl_exact_find_turning(s, item);
    }
    if (turns(s, item)) {
        pl_exact_turn(s, item, m);
    }
    for (uint32_t k = 0; k < m->count; ++k) {
        const pl_classic_point *p = &m->point[k];
        const double apart =
            turns(s, item) ? s->turnings[item->turning].apart[k] : separation_now(s, item, m, p);
        fill_normal(s, m, p, apart, share * (double)p->ln, &r[k]);
        fill_tangent(m, p, item->first_row + k, share * (double)p->lt, &r[m->count + k]);
        r[k].in_force = p->separation < PL_APART / 2;
        r[m->count + k].in_force = r[k].in_force && m->friction > 0;
    }
    if (m->rolling > 0) {
        const double kept = share * (double)m->lr;
        r[2 * m->count] = (pl_exact_row){ .j = { 0, 0, -1, 0, 0, 1 },
                                          .low = -kept,
                                          .factor = (double)m->rolling,
                                          .lead = item->first_row,
                                          .leads = (uint8_t)m->count,
                                          .kept = kept,
                                          .impulse = (double)m->lr - kept,
                                          .in_force = true };
    }
    r->stays = stays;
}

// Of which point a hit is to be told: it bore nothing and is pushed now. Where a sweep relaxes, bodies are where the next
// substep begins: it slows down what would strike in that.
static void note_strikes(const pl_exact_system *s, const pl_exact_item *item)
{
    pl_classic_contact *m = pl_exact_contact(s, item);
    const near_real since = s->since + (s->sweep == PL_SWEEP_RELAX ? s->h : 0);
    for (uint32_t k = 0; k < m->count; ++k) {
        const pl_exact_row *r = &s->rows[item->first_row + k];
        if (m->point[k].ln <= 0 && r->next > 0) {
            pl_classic_strike(m, (near_real)-pl_exact_rate(s, r, s->full),
                              (near_real)separation_now(s, item, m, &m->point[k]), since, s->h);
        }
    }
}

static void keep_contact(const pl_exact_system *s, const pl_exact_item *item)
{
    pl_classic_contact *m = pl_exact_contact(s, item);
    const pl_exact_row *r = s->rows + item->first_row;
    for (uint32_t k = 0; k < m->count; ++k) {
        const pl_exact_row *normal = &r[k], *tangent = &r[m->count + k];
        const double bound = (double)m->friction * (normal->next - normal->low);
        m->point[k].yields = fabs(tangent->next - tangent->low) >= (1 - ON_CONE) * bound;
        m->point[k].ln = (near_real)(normal->kept + normal->next);
        m->point[k].lt = (near_real)(tangent->kept + tangent->next);
    }
    if (s->sweep == PL_SWEEP_PULL) { // of what relaxes, pgs.c asks at the end of the substep
        pl_classic_grip(s->world, m);
    }
    if (m->rolling > 0) {
        m->lr = (near_real)(r[2 * m->count].kept + r[2 * m->count].next);
    }
}

//---- joints ----------------------------------------------------------------------------------------------

// What a row strives for.
static pl_row_law law_of(const pl_exact_system *s, const pl_lone *l, int i, pl_joint_sweep sweep)
{
    pl_row_law law;
    pl_row_law_of(l, i, sweep, false, s->recovery, &law);
    return law;
}

static void fill_joint(const pl_exact_system *s, const pl_exact_item *item)
{
    const bool stays = s->sweep == PL_SWEEP_RELAX && s->rows[item->first_row].stays;
    pl_lone l;
    pl_one_take(s->joints, item->joint, &l);
    pl_one_forget(l.joint);
    if (stays) { // what was given along J of before is told so (joints/finish.c)
        pl_one_turn(s->world, l.joint, l.a, l.b);
    } else {
        pl_one_rows(s->world, l.joint, l.a, l.b);
    }
    if (s->sweep == PL_SWEEP_RELAX) {
        pl_one_let_go(l.joint, l.a, l.b);
    }
    for (int i = 0; i < PL_JOINT_ROWS; ++i) {
        pl_exact_row *out = &s->rows[item->first_row + (uint32_t)i];
        *out = (pl_exact_row){ 0 };
        if (i >= l.joint->rows.count) {
            continue;
        }
        const pl_row *r = &l.joint->rows.row[i];
        const bool spring = pl_row_is_spring(r); // gives in both sweeps: spring.c
        const pl_row_law law = law_of(s, &l, i, spring ? PL_SWEEP_PULL : s->sweep);
        const double impulse = (double)l.joint->impulse[i], share = share_of(s);
        const bool keeps = stays || (spring && s->sweep == PL_SWEEP_RELAX);
        const double kept = keeps ? impulse : 0;
        *out = (pl_exact_row){ .j = { (double)r->ax, (double)r->ay, (double)r->aw, (double)r->bx,
                                      (double)r->by, (double)r->bw },
                               .target = law.target,
                               .undone = pl_row_is_rigid(r) ? law.target : 0,
                               .give = law.give,
                               .low = share * law.low - kept,
                               .high = share * law.high - kept,
                               .kept = kept,
                               .impulse = impulse - kept,
                               .in_force = law.in_force };
    }
}

static void keep_joint(const pl_exact_system *s, const pl_exact_item *item)
{
    pl_joint *j = pl_joint_grouped(&s->world->joints, item->joint);
    for (int i = 0; i < j->rows.count; ++i) {
        const pl_exact_row *r = &s->rows[item->first_row + (uint32_t)i];
        if (r->in_force) {
            j->impulse[i] = (real)(r->kept + r->next);
        }
    }
}

// [m/s], [rad/s] velocity of an end of an item, as the island has it now.
static void velocity_of(const pl_exact_system *s, const pl_exact_item *item, int end, double v[3])
{
    const pl_solver_body *body = &pl_solver_bodies(&s->world->solver)[item->slot[end]];
    const double here[3] = { (double)body->vx, (double)body->vy, (double)body->w };
    const uint32_t node = item->node[end];
    for (size_t c = 0; c < 3; ++c) {
        v[c] = node == PL_NONE ? here[c] : s->velocity[3 * (size_t)node + c];
    }
}

// What the turning of its bodies by w does to the anchors of a rigid point within the substep.
static void bend_point(const pl_exact_system *s, const pl_exact_item *item, const pl_lone *l)
{
    const pl_row *row = l->joint->rows.row;
    real arc[2] = { 0, 0 };
    for (int end = 0; end < 2; ++end) {
        double v[3];
        velocity_of(s, item, end, v);
        pl_one_add_arc(arc, (real)v[2], l->joint->h, end == 0 ? row[0].aw : row[0].bw,
                       end == 0 ? row[1].aw : row[1].bw);
    }
    for (uint32_t i = 0; i < 2; ++i) {
        s->rows[item->first_row + i].target =
            law_of(s, l, (int)i, s->sweep).target - (double)arc[i];
    }
}

// What J v could be, whichever way the bodies went.
static double fastest(const pl_exact_row *r, double v[2][3])
{
    double sum = 0;
    for (int end = 0; end < 2; ++end) {
        const double *j = r->j + 3 * end, *u = v[end];
        sum += sqrt((j[0] * j[0] + j[1] * j[1]) * (u[0] * u[0] + u[1] * u[1])) + fabs(j[2] * u[2]);
    }
    return sum;
}

// Of other rigid rows: by how much more than J v says their errors change in the substep. Up to half a radian, beyond which
// tangents lead nowhere near, less and less of it.
static void bend_rows(const pl_exact_system *s, const pl_exact_item *item, const pl_lone *l)
{
    const double h = (double)s->h;
    pl_solver_body then[2] = { *l->a, *l->b };
    double v[2][3];
    for (int end = 0; end < 2; ++end) {
        velocity_of(s, item, end, v[end]);
        then[end].dx += (near_real)(h * v[end][0]);
        then[end].dy += (near_real)(h * v[end][1]);
        then[end].da += (near_real)(h * v[end][2]);
    }
    pl_joint there = *l->joint;
    pl_one_rows(s->world, &there, &then[0], &then[1]);
    for (int i = 0; i < there.rows.count; ++i) {
        const pl_row *row = &l->joint->rows.row[i];
        pl_exact_row *r = &s->rows[item->first_row + (uint32_t)i];
        const bool bends = row->type == PL_ROW_EQUAL || row->type == PL_ROW_LEAST;
        if (!r->in_force || !bends || row->spring != PL_SPRING_NONE ||
            (i > 0 && i == l->joint->struck)) {
            continue;
        }
        const double grown = (double)there.rows.row[i].error - (double)row->error;
        const double arc = grown / h - pl_exact_rate(s, r, s->velocity);
        const double most = fastest(r, v), turn = 4 * fabs(arc);
        const double share =
            turn < most ? 1 - turn * turn * turn * turn / (most * most * most * most) : 0;
        r->target = law_of(s, l, i, s->sweep).target - share * arc;
    }
}

// Of a contact that turns: by how much more than J v says its points part in the substep.
static void bend_contact(const pl_exact_system *s, const pl_exact_item *item)
{
    const uint32_t count = pl_exact_contact(s, item)->count;
    double v[2][3], parted[2];
    velocity_of(s, item, 0, v[0]);
    velocity_of(s, item, 1, v[1]);
    pl_exact_part(s, item, v, parted);
    for (uint32_t k = 0; k < count; ++k) {
        pl_exact_row *r = &s->rows[item->first_row + k];
        const double arc = parted[k] / (double)s->h - pl_exact_rate(s, r, s->velocity);
        r->target = target_of(s, s->turnings[item->turning].apart[k]) - (r->in_force ? arc : 0);
    }
}

static void bend(const pl_exact_system *s, const pl_exact_item *item, int round)
{
    pl_lone l;
    pl_one_take(s->joints, item->joint, &l);
    const pl_row *row = l.joint->rows.row;
    if (row[0].form == PL_FORM_POINT_X) {
        if (pl_row_is_rigid(&row[0]) && s->rows[item->first_row].in_force) {
            bend_point(s, item, &l);
        }
    } else if (round < BENDS) {
        bend_rows(s, item, &l);
    }
}

//---- all -------------------------------------------------------------------------------------------------

static double mass_of(const pl_exact_system *s, const pl_exact_row *r)
{
    const uint32_t *node = r->item->node;
    double k = 0;
    for (int end = 0; end < 2; ++end) {
        for (int i = 0; node[end] != PL_NONE && i < 3; ++i) {
            const double j = r->j[3 * end + i];
            k += s->nodes[node[end]].inv_mass[i] * j * j;
        }
    }
    return k > 0 ? 1 / k : 0;
}

void pl_exact_fill(const pl_exact_system *s)
{
    for (uint32_t i = s->island->first_item; i < s->island->end_item; ++i) {
        const pl_exact_item *item = &s->items[i];
        double before[PL_JOINT_ROWS];
        for (uint32_t k = 0; k < item->row_count && s->sweep == PL_SWEEP_RELAX; ++k) {
            before[k] = s->rows[item->first_row + k].before;
        }
        if (item->joint == PL_NONE) {
            fill_contact(s, item);
        } else {
            fill_joint(s, item);
        }
        for (uint32_t k = item->first_row; k < item->first_row + item->row_count; ++k) {
            pl_exact_row *r = &s->rows[k];
            r->item = item;
            r->mass = r->in_force ? mass_of(s, r) : 0;
            r->before = s->sweep == PL_SWEEP_PULL ? r->impulse : before[k - item->first_row];
            r->impulse = s->missed ? r->before : r->impulse;
            r->in_force &= r->mass > 0;
            r->next = r->in_force ? r->impulse : 0;
        }
    }
}

void pl_exact_bend(const pl_exact_system *s, int round)
{
    for (uint32_t i = s->island->first_item; i < s->island->end_item; ++i) {
        if (s->items[i].joint != PL_NONE) {
            bend(s, &s->items[i], round);
        } else if (round < BENDS && turns(s, &s->items[i])) {
            bend_contact(s, &s->items[i]);
        }
    }
}

void pl_exact_keep(const pl_exact_system *s)
{
    for (uint32_t i = s->island->first_item; i < s->island->end_item; ++i) {
        const pl_exact_item *item = &s->items[i];
        if (item->joint != PL_NONE) {
            keep_joint(s, item);
            continue;
        }
        note_strikes(s, item);
        keep_contact(s, item);
    }
}

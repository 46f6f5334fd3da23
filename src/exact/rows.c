// rows.c - contacts and joints as scalar rows for the exact solver, and impulses back.
//
// A contact is those of the classic solver (solver.h): a normal row a point, then a tangent row a point, then rolling
// resistance; a joint is its rows as laws (joints/law.h). Sweeps that pull undo a share of overlaps and errors; those that
// relax leave speeds as the rows want them, from the same velocities: what was undone leaves no speed behind.
//
// Reads: contacts, joints, solver bodies. Writes: rows, impulses. Cost: O(rows).
#include "exact/exact.h"
#include "joints/law.h"

// Share of an overlap that a substep undoes.
#define RECOVERY 0.2

//---- contacts ------------------------------------------------------------------------------------------

static pl_classic_contact *contact_of(const pl_exact_system *s, const pl_exact_item *item)
{
    return (pl_classic_contact *)s->world->solver.classic.data + item->contact;
}

static double separation_now(const pl_exact_system *s, const pl_exact_item *item,
                             const pl_classic_contact *m, const pl_classic_point *p)
{
    const pl_solver_body *a = &pl_solver_bodies(&s->world->solver)[item->slot[0]];
    const pl_solver_body *b = &pl_solver_bodies(&s->world->solver)[item->slot[1]];
    return (double)p->separation + (double)m->nx * ((double)b->dx - (double)a->dx) +
           (double)m->ny * ((double)b->dy - (double)a->dy) + (double)p->rbn * (double)b->da -
           (double)p->ran * (double)a->da;
}

static void fill_normal(const pl_exact_system *s, const pl_exact_item *item,
                        const pl_classic_contact *m, const pl_classic_point *p, pl_exact_row *r)
{
    const double apart = separation_now(s, item, m, p), rate = apart / (double)s->h;
    const double push = (double)s->world->desc.push_speed, back = -RECOVERY * rate;
    const double pull = apart < (double)m->reach ? (double)m->pull : 0;
    *r = (pl_exact_row){ .j = { -(double)m->nx, -(double)m->ny, -(double)p->ran, (double)m->nx,
                                (double)m->ny, (double)p->rbn },
                         .target = apart > 0                    ? -rate
                                   : s->sweep == PL_SWEEP_RELAX ? 0
                                   : back < push                ? back
                                                                : push,
                         .low = -pull,
                         .high = (double)PL_UNBOUNDED,
                         .impulse = (double)p->ln };
}

static void fill_tangent(const pl_classic_contact *m, const pl_classic_point *p, uint32_t lead,
                         pl_exact_row *r)
{
    *r = (pl_exact_row){ .j = { (double)m->ny, -(double)m->nx, -(double)p->rat, -(double)m->ny,
                                (double)m->nx, (double)p->rbt },
                         .target = -(double)m->surface_speed,
                         .factor = (double)m->friction,
                         .lead = lead,
                         .leads = 1,
                         .impulse = (double)p->lt };
}

static void fill_contact(const pl_exact_system *s, const pl_exact_item *item)
{
    const pl_classic_contact *m = contact_of(s, item);
    pl_exact_row *r = s->rows + item->first_row;
    for (uint32_t k = 0; k < m->count; ++k) {
        fill_normal(s, item, m, &m->point[k], &r[k]);
        fill_tangent(m, &m->point[k], item->first_row + k, &r[m->count + k]);
        r[k].in_force = m->point[k].separation < PL_APART / 2;
        r[m->count + k].in_force = r[k].in_force && m->friction > 0;
    }
    if (m->rolling > 0) {
        r[2 * m->count] = (pl_exact_row){ .j = { 0, 0, -1, 0, 0, 1 },
                                          .factor = (double)m->rolling,
                                          .lead = item->first_row,
                                          .leads = (uint8_t)m->count,
                                          .impulse = (double)m->lr,
                                          .in_force = true };
    }
}

// Of which point a hit is to be told: it bore nothing and is pushed now. Where a sweep relaxes, bodies are where the next
// substep begins: it slows down what would strike in that.
static void note_strikes(const pl_exact_system *s, const pl_exact_item *item)
{
    pl_classic_contact *m = contact_of(s, item);
    const near_real since = s->since + (s->sweep == PL_SWEEP_RELAX ? s->h : 0);
    for (uint32_t k = 0; k < m->count; ++k) {
        const pl_exact_row *r = &s->rows[item->first_row + k];
        if (m->point[k].ln <= 0 && r->next > 0) {
            pl_classic_strike(m, (near_real)-pl_exact_rate(s, r, s->base),
                              (near_real)separation_now(s, item, m, &m->point[k]), since, s->h);
        }
    }
}

static void keep_contact(const pl_exact_system *s, const pl_exact_item *item)
{
    pl_classic_contact *m = contact_of(s, item);
    const pl_exact_row *r = s->rows + item->first_row;
    for (uint32_t k = 0; k < m->count; ++k) {
        m->point[k].ln = (near_real)r[k].next;
        m->point[k].lt = (near_real)r[m->count + k].next;
    }
    if (m->rolling > 0) {
        m->lr = (near_real)r[2 * m->count].next;
    }
}

//---- joints ----------------------------------------------------------------------------------------------

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
        const pl_row_law law = pl_row_law_of(&l, i, s->sweep);
        const double impulse = (double)l.joint->impulse[i];
        const double kept = stays ? impulse : 0;
        *out = (pl_exact_row){ .j = { (double)r->ax, (double)r->ay, (double)r->aw, (double)r->bx,
                                      (double)r->by, (double)r->bw },
                               .target = law.target,
                               .give = law.give,
                               .low = law.low - kept,
                               .high = law.high - kept,
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

// What the turning of its bodies by w does to the anchors of a rigid point within the substep.
static void bend(const pl_exact_system *s, const pl_exact_item *item)
{
    const pl_joint *j = pl_joint_grouped(&s->world->joints, item->joint);
    const pl_row *row = j->rows.row;
    pl_exact_row *r = s->rows + item->first_row;
    if (row[0].form != PL_FORM_POINT_X || row[0].type != PL_ROW_EQUAL || !r[0].in_force) {
        return;
    }
    real arc[2] = { 0, 0 };
    for (int end = 0; end < 2; ++end) {
        const uint32_t node = item->node[end];
        const real w = node == PL_NONE
                           ? (real)pl_solver_bodies(&s->world->solver)[item->slot[end]].w
                           : (real)s->velocity[3 * (size_t)node + 2];
        pl_one_add_arc(arc, w, j->h, end == 0 ? row[0].aw : row[0].bw,
                       end == 0 ? row[1].aw : row[1].bw);
    }
    pl_lone l;
    pl_one_take(s->joints, item->joint, &l);
    for (int i = 0; i < 2; ++i) {
        r[i].target = pl_row_law_of(&l, i, s->sweep).target - (double)arc[i];
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

void pl_exact_bend(const pl_exact_system *s)
{
    for (uint32_t i = s->island->first_item; i < s->island->end_item; ++i) {
        if (s->items[i].joint != PL_NONE) {
            bend(s, &s->items[i]);
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

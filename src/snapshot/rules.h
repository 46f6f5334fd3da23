// rules.h - what the numbers of an image must be like, a row a column: PL_RULE_<table>_<column>. A column
// without a rule does not compile (section.c). Numbers of bool and floating types are 0 or 1, or finite, without
// a row saying so; how rows hang together is the business of check.c.
//
//   ANY           nothing more
//   GUARDED       any number at all: the guard of a step takes out what would not stay finite (step/quarantine.c)
//   POSITIVE      not below 0
//   UP_TO(n)      at most n
//   PLACE(what)   below the count of it;  OR_NONE: or PL_NONE;  ONE_MORE: 1 + such a place, or 0
#ifndef PL_RULES_H
#define PL_RULES_H

#include "plumb/joint.h"

#include <stdint.h>

typedef enum pl_rule_kind {
    PL_RULE_IS_ANY,
    PL_RULE_IS_GUARDED,
    PL_RULE_IS_POSITIVE,
    PL_RULE_IS_UP_TO,
    PL_RULE_IS_PLACE,
    PL_RULE_IS_PLACE_OR_NONE,
    PL_RULE_IS_ONE_MORE
} pl_rule_kind;

// What places are of.
enum {
    PL_OF_BODIES,
    PL_OF_PIECES,
    PL_OF_MATERIALS,
    PL_OF_JOINTS,
    PL_OF_CHARACTERS,
    PL_OF_TUNINGS,
    PL_OF_ISLANDS,
    PL_OF_DORMANTS
};

typedef struct pl_rule {
    pl_rule_kind kind;
    uint32_t of; // what a place is of; the most
} pl_rule;

#define ANY                                                                                        \
    {                                                                                              \
        PL_RULE_IS_ANY, 0                                                                          \
    }
#define GUARDED                                                                                    \
    {                                                                                              \
        PL_RULE_IS_GUARDED, 0                                                                      \
    }
#define POSITIVE                                                                                   \
    {                                                                                              \
        PL_RULE_IS_POSITIVE, 0                                                                     \
    }
#define UP_TO(n)                                                                                   \
    {                                                                                              \
        PL_RULE_IS_UP_TO, n                                                                        \
    }
#define PLACE(of)                                                                                  \
    {                                                                                              \
        PL_RULE_IS_PLACE, PL_OF_##of                                                               \
    }
#define OR_NONE(of)                                                                                \
    {                                                                                              \
        PL_RULE_IS_PLACE_OR_NONE, PL_OF_##of                                                       \
    }
#define ONE_MORE(of)                                                                               \
    {                                                                                              \
        PL_RULE_IS_ONE_MORE, PL_OF_##of                                                            \
    }

#define PL_RULE_bodies_entity          ANY
#define PL_RULE_bodies_x               ANY
#define PL_RULE_bodies_y               ANY
#define PL_RULE_bodies_center_x        ANY
#define PL_RULE_bodies_center_y        ANY
#define PL_RULE_bodies_c               ANY
#define PL_RULE_bodies_s               ANY
#define PL_RULE_bodies_vx              GUARDED
#define PL_RULE_bodies_vy              GUARDED
#define PL_RULE_bodies_w               GUARDED
#define PL_RULE_bodies_low_x           ANY
#define PL_RULE_bodies_low_y           ANY
#define PL_RULE_bodies_low_vx          ANY
#define PL_RULE_bodies_low_vy          ANY
#define PL_RULE_bodies_fx              GUARDED
#define PL_RULE_bodies_fy              GUARDED
#define PL_RULE_bodies_torque          GUARDED
#define PL_RULE_bodies_inv_mass        POSITIVE
#define PL_RULE_bodies_inv_inertia     POSITIVE
#define PL_RULE_bodies_local_x         ANY
#define PL_RULE_bodies_local_y         ANY
#define PL_RULE_bodies_gravity_scale   ANY
#define PL_RULE_bodies_mass            POSITIVE
#define PL_RULE_bodies_inertia         POSITIVE
#define PL_RULE_bodies_set_mass        POSITIVE
#define PL_RULE_bodies_set_inertia     POSITIVE
#define PL_RULE_bodies_extent          POSITIVE
#define PL_RULE_bodies_slack           ANY
#define PL_RULE_bodies_user_data       ANY
#define PL_RULE_bodies_first_piece     OR_NONE(PIECES)
#define PL_RULE_bodies_first_joint     OR_NONE(JOINTS)
#define PL_RULE_bodies_character       ONE_MORE(CHARACTERS)
#define PL_RULE_bodies_looked          ANY
#define PL_RULE_bodies_look_x          ANY
#define PL_RULE_bodies_look_y          ANY
#define PL_RULE_bodies_look_c          ANY
#define PL_RULE_bodies_look_s          ANY
#define PL_RULE_bodies_way_x           ANY
#define PL_RULE_bodies_way_y           ANY
#define PL_RULE_bodies_way_turn        ANY
#define PL_RULE_bodies_looks           UP_TO(2)
#define PL_RULE_bodies_island          OR_NONE(ISLANDS)
#define PL_RULE_bodies_next_asleep     ANY
#define PL_RULE_bodies_previous_asleep ANY
#define PL_RULE_bodies_changed_step    ANY
#define PL_RULE_bodies_tuning          ONE_MORE(TUNINGS)
#define PL_RULE_bodies_stirring        ANY
#define PL_RULE_bodies_type            UP_TO(PLUMB_STATIC)
#define PL_RULE_bodies_flags           UP_TO(0x3fff) // but PL_BODY_LOST

#define PL_RULE_pieces_shape         ANY
#define PL_RULE_pieces_kind          UP_TO(PL_PIECE_KIND_COUNT - 1)
#define PL_RULE_pieces_shape_kind    UP_TO(PLUMB_CHAIN)
#define PL_RULE_pieces_vertex_count  UP_TO(16)
#define PL_RULE_pieces_vertex_class  UP_TO(PL_VERTEX_CLASSES - 1)
#define PL_RULE_pieces_vertices      ANY
#define PL_RULE_pieces_seams         ANY
#define PL_RULE_pieces_seam_corners  ANY
#define PL_RULE_pieces_seam_edges    ANY
#define PL_RULE_pieces_body          ANY
#define PL_RULE_pieces_next_in_body  OR_NONE(PIECES)
#define PL_RULE_pieces_next_in_shape OR_NONE(PIECES)
#define PL_RULE_pieces_material      ANY
#define PL_RULE_pieces_category      ANY
#define PL_RULE_pieces_mask          ANY
#define PL_RULE_pieces_group         ANY
#define PL_RULE_pieces_flags         UP_TO(63)
#define PL_RULE_pieces_friction      POSITIVE
#define PL_RULE_pieces_restitution   POSITIVE
#define PL_RULE_pieces_one_way_x     ANY
#define PL_RULE_pieces_one_way_y     ANY
#define PL_RULE_pieces_one_way_cos   ANY
#define PL_RULE_pieces_one_way_angle ANY
#define PL_RULE_pieces_density       POSITIVE
#define PL_RULE_pieces_own_density   POSITIVE
#define PL_RULE_pieces_area          ANY
#define PL_RULE_pieces_serial        ANY
#define PL_RULE_pieces_user_data     ANY
#define PL_RULE_pieces_core          ANY
#define PL_RULE_pieces_fat           ANY
#define PL_RULE_pieces_moving        ANY
#define PL_RULE_pieces_first_dormant OR_NONE(DORMANTS)

#define PL_RULE_materials_entity          ANY
#define PL_RULE_materials_density         POSITIVE
#define PL_RULE_materials_friction        POSITIVE
#define PL_RULE_materials_restitution     POSITIVE
#define PL_RULE_materials_rolling         POSITIVE
#define PL_RULE_materials_surface_speed   ANY
#define PL_RULE_materials_adhesion        POSITIVE
#define PL_RULE_materials_friction_mix    UP_TO(PLUMB_MIX_MAX)
#define PL_RULE_materials_restitution_mix UP_TO(PLUMB_MIX_MAX)
#define PL_RULE_materials_adhesion_mix    UP_TO(PLUMB_MIX_MAX)
#define PL_RULE_materials_pairs           ANY
#define PL_RULE_materials_users           ANY

#endif

// complete.c - a build in which a member of the world is missing in list.h fails here.
//
// The headers are read with all padding taken out; the sizes of the members listed must then add up
// to the size of each struct, exactly. No code comes of this file.
#include <limits.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#pragma pack(push, 1)
#include "snapshot/list.h"
#include "world/desc_list.h"
#pragma pack(pop)

#define SIZE(path)                                   +sizeof PL_STATE_OF(path)
#define ARRAY_SIZE(type, buffer, count, hashed, key) SIZE(buffer) SIZE(count)
#define COLUMN_SIZE(type, name, ...)                 +sizeof(void *)

// A table with its columns; members besides are rows of their own.
#define TABLE_SIZE(path)     TABLE_SIZE_##path
#define TABLE_SIZE_bodies    +(sizeof(pl_table) PL_BODY_COLUMNS(COLUMN_SIZE))
#define TABLE_SIZE_pieces    +(sizeof(pl_table) PL_PIECE_COLUMNS(COLUMN_SIZE))
#define TABLE_SIZE_materials +(sizeof(pl_table) PL_MATERIAL_COLUMNS(COLUMN_SIZE))

#define LISTED(list) (0 list(SIZE, SIZE, ARRAY_SIZE, TABLE_SIZE, SIZE, SIZE))
#define COMPLETE(list, path)                                                                       \
    _Static_assert(LISTED(list) == sizeof PL_STATE_OF(path),                                       \
                   "a member of plumb_world." #path " is not in snapshot/list.h: add its row")

COMPLETE(PL_STATE_DESC, desc);
COMPLETE(PL_STATE_REGISTRY, registry);
COMPLETE(PL_STATE_PIECES, pieces);
COMPLETE(PL_STATE_VERTICES, vertices);
COMPLETE(PL_STATE_COMMANDS, commands);
COMPLETE(PL_STATE_BROAD, broad);
COMPLETE(PL_STATE_NARROW, narrow);
COMPLETE(PL_STATE_SOLVER, solver);
COMPLETE(PL_STATE_JOINTS, joints);
COMPLETE(PL_STATE_PARTS, parts);
COMPLETE(PL_STATE_PENDING_HITS, pending_hits);
COMPLETE(PL_STATE_SENSING, sensing);
COMPLETE(PL_STATE_SLEEP, sleep);
COMPLETE(PL_STATE_INTERNAL_EDGES, internal_edges);
COMPLETE(PL_STATE_CHARACTERS, characters);
COMPLETE(PL_STATE_CONTINUOUS, continuous);
COMPLETE(PL_STATE_LIQUID, liquid);
COMPLETE(PL_STATE_AIR, air);
COMPLETE(PL_STATE_SOFTBODIES, softbodies);
COMPLETE(PL_STATE_LAWS, laws);
COMPLETE(PL_STATE_WAVES, waves);
COMPLETE(PL_STATE_FRACTURE, fracture);
COMPLETE(PL_STATE_HEATS, heats);
COMPLETE(PL_STATE_DIAL, dial);
_Static_assert(LISTED(PL_STATE) == sizeof(plumb_world),
               "a member of plumb_world is not in snapshot/list.h: add its row");

// Members of descriptors; the points of a shape are kept elsewhere.
#define MEMBER_SIZE(desc, path)   +sizeof(((desc *)0)->path)
#define BODY_DESC_SIZE(path)      MEMBER_SIZE(plumb_body_desc, path)
#define SHAPE_DESC_SIZE(path)     MEMBER_SIZE(plumb_shape_desc, path)
#define JOINT_DESC_SIZE(path)     MEMBER_SIZE(plumb_joint_desc, path)
#define CHARACTER_DESC_SIZE(path) MEMBER_SIZE(plumb_character_desc, path)
#define LAW_DESC_SIZE(path)       MEMBER_SIZE(plumb_law_desc, path)
#define MATERIAL_DESC_SIZE(path)  MEMBER_SIZE(plumb_material_desc, path)
#define PAIR_DESC_SIZE(path)      MEMBER_SIZE(plumb_material_pair, path)
#define COMPLETE_DESC(sizes, desc)                                                                 \
    _Static_assert((sizes) == sizeof(desc),                                                        \
                   "a member of " #desc " is not in world/desc_list.h or src/schema")

COMPLETE_DESC(0 PL_MATERIAL_ROWS(PL_ROW_MEMBERS, MATERIAL_DESC_SIZE), plumb_material_desc);
COMPLETE_DESC(0 PL_MATERIAL_PAIR_ROWS(PL_ROW_MEMBERS, PAIR_DESC_SIZE), plumb_material_pair);
COMPLETE_DESC(0 PL_BODY_DESC(BODY_DESC_SIZE), plumb_body_desc);
COMPLETE_DESC(sizeof(void *) PL_SHAPE_DESC(SHAPE_DESC_SIZE), plumb_shape_desc);
COMPLETE_DESC(0 PL_JOINT_DESC(JOINT_DESC_SIZE), plumb_joint_desc);
COMPLETE_DESC(0 PL_LAW_DESC(LAW_DESC_SIZE) PL_LAW_TEXTS(LAW_DESC_SIZE), plumb_law_desc);
COMPLETE_DESC(0 PL_CHARACTER_DESC(CHARACTER_DESC_SIZE), plumb_character_desc);

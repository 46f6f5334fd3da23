// columns.c - column descriptors of the built-in tables, expanded from the lists in columns.h.
#include "world/columns.h"

#define COUNT(array) (sizeof(array) / sizeof((array)[0]))

#define BODY_COLUMN(type, name, ...)     { offsetof(pl_bodies, name), sizeof(type) },
#define PIECE_COLUMN(type, name, ...)    { offsetof(pl_pieces, name), sizeof(type) },
#define MATERIAL_COLUMN(type, name, ...) { offsetof(pl_materials, name), sizeof(type) },

const pl_column pl_body_columns[] = { PL_BODY_COLUMNS(BODY_COLUMN) };
const size_t pl_body_column_count = COUNT(pl_body_columns);

const pl_column pl_piece_columns[] = { PL_PIECE_COLUMNS(PIECE_COLUMN) };
const size_t pl_piece_column_count = COUNT(pl_piece_columns);

const pl_column pl_material_columns[] = { PL_MATERIAL_COLUMNS(MATERIAL_COLUMN) };
const size_t pl_material_column_count = COUNT(pl_material_columns);

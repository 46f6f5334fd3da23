// check.h - validation at the API boundary. Every check returns PLUMB_OK or records a message of
// the form
// "<function>: <field> is <value>; <requirement>" and returns its code.
#ifndef PL_CHECK_H
#define PL_CHECK_H

#include "core/try.h"
#include "plumb/schema.h"
#include "plumb/shape.h"
#include "schema/effects.h"

// A world is given. E_NULL, which nobody is told.
static inline plumb_result pl_check_world(const plumb_world *world)
{
    return world != NULL ? PLUMB_OK : PLUMB_E_NULL;
}

// Finite. E_NOT_FINITE.
plumb_result pl_check_finite(const plumb_world *world, const char *function, const char *field,
                             plumb_real value);
plumb_result pl_check_finite_vec(const plumb_world *world, const char *function, const char *field,
                                 plumb_vec2 value);

// Finite and low <= value <= high; high PLUMB_REAL_MAX: no upper bound. E_NOT_FINITE, E_RANGE.
plumb_result pl_check_range(const plumb_world *world, const char *function, const char *field,
                            plumb_real value, plumb_real low, plumb_real high);

// Both components finite and within +-limit. E_NOT_FINITE, E_RANGE.
plumb_result pl_check_within(const plumb_world *world, const char *function, const char *field,
                             plumb_vec2 value, plumb_real limit);

// Every property of a descriptor in its range, by the rows of src/schema; fields are told with `prefix`, "pair." or
// "". E_NOT_FINITE, E_RANGE.
// Whether two descriptors mean the same, whatever of them is left at 0.
bool pl_descs_agree(plumb_property_table table, const void *a, const void *b);
plumb_result pl_check_desc(const plumb_world *world, const char *function, const char *prefix,
                           plumb_property_table table, const void *desc);
// One value of a setter; a 0 that means the default is not one of them. E_NOT_FINITE, E_RANGE.
plumb_result pl_check_property(const plumb_world *world, const char *function, const char *field,
                               plumb_property_table table, const char *name, plumb_real value);
// The same of one that lies in an image.
bool pl_desc_is_sound(plumb_property_table table, const void *desc);

// Whether the library has an effect (schema/effects.h). E_UNSUPPORTED.
plumb_result pl_fail_absent(const plumb_world *world, const char *function, const char *what,
                            const char *effect);
#define PL_CHECK_HAS(world, function, what, NAME, name)                                            \
    (PL_HAS(NAME) ? PLUMB_OK : pl_fail_absent(world, function, what, name))

// Defaults of a world's settings (world.c).
void pl_world_resolve(plumb_world_desc *desc);

// Pointer given. E_NULL.
plumb_result pl_check_pointer(const plumb_world *world, const char *function, const char *field,
                              const void *pointer);

// 1..63 characters. E_NULL, E_RANGE.
plumb_result pl_check_name(const plumb_world *world, const char *function, const char *field,
                           const char *name);

// A live body, shape or material (null: the default one); *row receives its body row, first piece
// or material row. E_HANDLE.
plumb_result pl_check_body(const plumb_world *world, const char *function, plumb_body body,
                           uint32_t *row);
// The same, and dynamic. E_HANDLE, E_STATE.
plumb_result pl_check_dynamic(const plumb_world *world, const char *function, plumb_body body,
                              uint32_t *row);
plumb_result pl_check_shape(const plumb_world *world, const char *function, plumb_shape shape,
                            uint32_t *piece);
plumb_result pl_check_material(const plumb_world *world, const char *function,
                               plumb_material material, uint32_t *row);
// No piece names the material of a row. E_STATE.
plumb_result pl_check_unused(const plumb_world *world, const char *function, uint32_t row);
// A live entity of any kind. E_HANDLE.
plumb_result pl_check_entity(const plumb_world *world, const char *function, plumb_entity entity);

// The body row, or first piece, for a getter that returns no result: PL_NONE, and the refusal told, for a bad
// handle. Nothing is told of a null world.
uint32_t pl_ask_body(const plumb_world *world, const char *function, plumb_body body);
uint32_t pl_ask_shape(const plumb_world *world, const char *function, plumb_shape shape);

// "body", "shape", ... of a plumb_entity_kind; NULL: it is none.
const char *pl_kind_name(uint32_t kind);
// Records that a handle is not `wanted` ("a live body"): what it is instead is found out here. E_HANDLE; E_NULL, and
// nothing is told, of a null world.
plumb_result pl_fail_handle(const plumb_world *world, const char *function, const char *field,
                            plumb_entity entity, const char *wanted);
plumb_result pl_fail_memory(const plumb_world *world, const char *function);

#endif

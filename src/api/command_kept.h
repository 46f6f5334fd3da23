// command_kept.h - how records keep descriptors: for who writes them and who reads what was saved.
#ifndef PL_API_COMMAND_KEPT_H
#define PL_API_COMMAND_KEPT_H

#include "api/command.h"
#include "world/desc_list.h"

#include <string.h>

#define PL_KEPT_ALIGN 16u // of records and payloads: enough for any descriptor

// Descriptors as they are kept: member after member.
#define PL_KEPT_BODY_MEMBER(path)  +sizeof(((plumb_body_desc *)0)->path)
#define PL_KEPT_SHAPE_MEMBER(path) +sizeof(((plumb_shape_desc *)0)->path)
#define PL_KEPT_BODY               (0 PL_BODY_DESC(PL_KEPT_BODY_MEMBER))
#define PL_KEPT_SHAPE              (0 PL_SHAPE_DESC(PL_KEPT_SHAPE_MEMBER))

#define PL_KEPT_GET(path)                                                                          \
    memcpy(&desc.path, from, sizeof desc.path);                                                    \
    from += sizeof desc.path;

static inline plumb_body_desc pl_kept_body(const char *from)
{
    plumb_body_desc desc = { 0 };
    PL_BODY_DESC(PL_KEPT_GET)
    return desc;
}

static inline plumb_shape_desc pl_kept_shape(const char *from)
{
    plumb_shape_desc desc = { 0 };
    PL_SHAPE_DESC(PL_KEPT_GET)
    return desc;
}

static inline size_t pl_kept_room(size_t bytes)
{
    return (bytes + (PL_KEPT_ALIGN - 1)) & ~(size_t)(PL_KEPT_ALIGN - 1);
}

#endif

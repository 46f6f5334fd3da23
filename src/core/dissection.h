// dissection.h - cuts a component of a graph into small parts: what cuts is eliminated last.
#ifndef PL_DISSECTION_H
#define PL_DISSECTION_H

#include "core/elimination.h"

// Words of scratch.
size_t pl_dissection_words(uint32_t vertices);
// Sorts the vertices of a component: those that degrees may order, then those that cut, in their order. Returns how many the first are.
uint32_t pl_dissect(const pl_elimination *e, uint32_t *queue, uint32_t count, uint32_t *scratch);

#endif

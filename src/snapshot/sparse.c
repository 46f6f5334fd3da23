// sparse.c - see sparse.h. Reads, writes: the buffers. Cost: O(bytes).
#include "snapshot/sparse.h"

#include <string.h>

//---- writing -------------------------------------------------------------------------------------

void pl_sparse_put_byte(pl_sparse_coder *c, unsigned byte)
{
    if (c->used < c->size) {
        c->to[c->used] = (unsigned char)byte;
    }
    ++c->used;
}

void pl_sparse_put_number(pl_sparse_coder *c, uint32_t v)
{
    for (; v >= 128; v >>= 7) {
        pl_sparse_put_byte(c, (v & 127) | 128);
    }
    pl_sparse_put_byte(c, v);
}

static void put_zeros(pl_sparse_coder *c)
{
    if (c->zero_groups > 0) {
        pl_sparse_put_byte(c, 0);
        pl_sparse_put_number(c, c->zero_groups);
        c->zero_groups = 0;
    }
}

static void put_group(pl_sparse_coder *c)
{
    unsigned words = 0, halves[8] = { 0 };
    for (unsigned k = 0; k < PL_SPARSE_GROUP; ++k) {
        if (c->group[k] != 0) {
            words |= 1u << k / 4;
            halves[k / 4] |= 1u << k % 4;
        }
    }
    c->fill = 0;
    if (words == 0) {
        ++c->zero_groups;
        return;
    }
    put_zeros(c);
    pl_sparse_put_byte(c, words);
    unsigned pending = 0, have = 0;
    for (unsigned k = 0; k < 8; ++k) {
        if ((words >> k & 1) != 0) {
            pending |= halves[k] << (have == 0 ? 0 : 4);
            if (++have == 2) {
                pl_sparse_put_byte(c, pending);
                pending = have = 0;
            }
        }
    }
    if (have > 0) {
        pl_sparse_put_byte(c, pending);
    }
    for (unsigned k = 0; k < PL_SPARSE_GROUP; ++k) {
        if (c->group[k] != 0) {
            pl_sparse_put_byte(c, c->group[k]);
        }
    }
}

void pl_sparse_put(pl_sparse_coder *c, const char *to, const char *from, size_t bytes)
{
    while (bytes > 0) {
        size_t part = PL_SPARSE_GROUP - c->fill < bytes ? PL_SPARSE_GROUP - c->fill : bytes;
        for (size_t k = 0; k < part; ++k) {
            c->group[c->fill + k] = (unsigned char)((unsigned char)to[k] ^
                                                    (from == NULL ? 0u : (unsigned char)from[k]));
        }
        c->fill += (uint32_t)part;
        if (c->fill == PL_SPARSE_GROUP) {
            put_group(c);
        }
        to += part;
        from = from == NULL ? NULL : from + part;
        bytes -= part;
    }
}

void pl_sparse_end(pl_sparse_coder *c)
{
    if (c->fill > 0) {
        memset(c->group + c->fill, 0, PL_SPARSE_GROUP - c->fill);
        put_group(c);
    }
    put_zeros(c);
}

//---- reading -------------------------------------------------------------------------------------

static unsigned get(pl_sparse_decoder *d)
{
    if (d->used == d->size) {
        d->damaged = true;
        return 0;
    }
    return d->from[d->used++];
}

uint32_t pl_sparse_get_number(pl_sparse_decoder *d)
{
    uint32_t v = 0;
    for (unsigned shift = 0; shift < 35; shift += 7) {
        unsigned byte = get(d);
        v |= (uint32_t)(byte & 127) << shift;
        if (byte < 128) {
            return v;
        }
    }
    d->damaged = true;
    return 0;
}

static void get_group(pl_sparse_decoder *d)
{
    memset(d->group, 0, PL_SPARSE_GROUP);
    d->left = PL_SPARSE_GROUP;
    if (d->zero_groups > 0) {
        --d->zero_groups;
        return;
    }
    unsigned words = get(d);
    if (words == 0) {
        d->zero_groups = pl_sparse_get_number(d) - 1;
        return;
    }
    unsigned halves[8] = { 0 }, pending = 0, have = 0;
    for (unsigned k = 0; k < 8; ++k) {
        if ((words >> k & 1) != 0) {
            if (have == 0) {
                pending = get(d);
                have = 2;
            }
            halves[k] = pending & 15;
            pending >>= 4;
            --have;
        }
    }
    for (unsigned k = 0; k < PL_SPARSE_GROUP; ++k) {
        if ((halves[k / 4] >> k % 4 & 1) != 0) {
            d->group[k] = (unsigned char)get(d);
        }
    }
}

void pl_sparse_get(pl_sparse_decoder *d, char *to, const char *from, size_t bytes)
{
    while (bytes > 0 && !d->damaged) {
        if (d->left == 0) {
            get_group(d);
        }
        size_t part = d->left < bytes ? d->left : bytes;
        const unsigned char *group = d->group + (PL_SPARSE_GROUP - d->left);
        for (size_t k = 0; k < part; ++k) {
            to[k] = (char)(group[k] ^ (from == NULL ? 0u : (unsigned char)from[k]));
        }
        d->left -= (uint32_t)part;
        to += part;
        from = from == NULL ? NULL : from + part;
        bytes -= part;
    }
}

void pl_sparse_drop(pl_sparse_decoder *d)
{
    d->left = d->zero_groups = 0;
}

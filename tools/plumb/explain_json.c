/// explain_json.c - `plumb explain --json`: the keys of README.md, in this order.
#include "explain.h"

#include <string.h>

static void text(const char *key, const char *value)
{
    printf("\"%s\": ", key);
    cli_print_json(stdout, value);
}

/// Names with commas between them as a list.
static void names(const char *key, const char *list)
{
    printf("\"%s\": [", key);
    for (const char *at = list; *at != '\0'; at += strspn(at, ", ")) {
        char name[64];
        const size_t length = strcspn(at, ",");
        snprintf(name, sizeof name, "%.*s", (int)length, at);
        printf("%s", at == list ? "" : ", ");
        cli_print_json(stdout, name);
        at += length;
    }
    printf("]");
}

static void texts(const char *key, const char *const *list, int count)
{
    printf("\"%s\": [", key);
    for (int i = 0; i < count; i++) {
        printf("%s", i == 0 ? "" : ", ");
        cli_print_json(stdout, list[i]);
    }
    printf("]");
}

static void print_pass(const explain_report *r, const engine_pass *pass)
{
    const pass_tally *ran = explain_find(r->tally, pass);
    const engine_because *b = &ran->because;
    printf("    { ");
    text("name", pass->name);
    printf(", ");
    text("stage", pass->phase);
    printf(", \"runs\": %s, \"steps\": %lld, \"in_substeps\": %s, \"user\": %s,\n      ",
           ran->steps > 0 ? "true" : "false", ran->steps, pass->in_substeps ? "true" : "false",
           pass->is_user ? "true" : "false");
    text("why", ran->reason);
    if (ran->steps > 0) {
        printf(", \"because\": ");
        if (b->first[0] != '\0') {
            printf("{ ");
            text("first", b->first);
            printf(", \"count\": %d }", b->count);
        } else {
            printf("null");
        }
        if (b->rows >= 0) {
            printf(", \"rows\": %ld, ", b->rows);
            text("rows_of", b->what);
        } else {
            printf(", \"rows\": null, \"rows_of\": null");
        }
        printf(", \"bytes\": %.0f", b->bytes);
    }
    if (r->total > 0 && ran->steps > 0) {
        printf(", \"share\": %.6f, \"ns\": %.1f", pass->total_ns / r->total,
               pass->total_ns / (double)r->run->steps);
    }
    printf(",\n      ");
    names("reads", pass->reads);
    printf(", ");
    names("writes", pass->writes);
    printf(",\n      ");
    texts("variants", pass->variants, pass->variant_count);
    printf(", ");
    texts("away", pass->away, pass->away_count);
    printf(" }");
}

void explain_json(const explain_report *r)
{
    const engine_info *info = &r->run->info;
    const engine_stats s = r->run->engine->stats(r->run->stage);
    char solver[16] = "";
    (void)cli_member(ENGINE_SOLVERS, info->solver, solver, sizeof solver);
    printf("{\n  ");
    text("scene", info->name);
    printf(", ");
    text("file", r->path);
    printf(",\n  ");
    text("precision", r->run->engine->precision);
    printf(", ");
    text("solver", solver);
    printf(", \"substeps\": %d, \"iterations\": %d, \"width\": %d, \"dt\": %.17g, \"steps\": "
           "%lld,\n  ",
           info->substeps, info->iterations, info->width, info->dt, r->run->steps);
    printf("\"bodies\": %u, \"moving\": %u, \"asleep\": %u, \"soft_asleep\": %u, \"shapes\": %u, "
           "\"pieces\": %u, "
           "\"pairs\": %u, \"contacts\": %u,\n  ",
           s.bodies, s.moving, s.asleep, s.soft_asleep, s.shapes, s.pieces, s.pairs, s.contacts);
    printf("\"lacks\": [");
    for (int i = 0; r->run->engine->lacks(i) != NULL; i++) {
        printf("%s\"%s\"", i == 0 ? "" : ", ", r->run->engine->lacks(i));
    }
    printf("],\n  \"passes\": [\n");
    for (int i = 0; i < r->count; i++) {
        print_pass(r, &r->list[i]);
        printf("%s\n", i + 1 < r->count ? "," : "");
    }
    printf("  ],\n  \"unused\": [");
    for (int i = 0; i < r->unused_count; i++) {
        printf("%s\n    { ", i == 0 ? "" : ",");
        text("rule", r->unused[i].rule);
        printf(", ");
        text("text", r->unused[i].text);
        printf(", \"more\": %d", r->unused[i].more);
        printf(", ");
        text("advice", r->unused[i].advice);
        printf(" }");
    }
    printf("%s]\n}\n", r->unused_count > 0 ? "\n  " : "");
}

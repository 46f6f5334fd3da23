// table.c - what the referee has found, as a table for a terminal, Markdown, CSV (referee.h).
#include "referee.h"

#include <math.h>
#include <string.h>

enum { REASONS_MAX = 24 };

bool referee_holds(const struct cell *cell)
{
    bool all = cell->status == CELL_JUDGED;
    for (int i = 0; i < cell->count; i++) {
        all = all && cell->lines[i].holds;
    }
    return all;
}

void referee_name(const char *path, char *name, size_t size)
{
    const char *base = strrchr(path, '/');
    snprintf(name, size, "%s", base != NULL ? base + 1 : path);
    name[strcspn(name, ".")] = '\0';
}

// The scene's lines: those of the first engine that has any.
static const struct cell *lines_of(const struct referee *r, const struct task *task)
{
    for (int c = 0; c < r->contender_count; c++) {
        if (task->cells[c].count > 0) {
            return &task->cells[c];
        }
    }
    return &task->cells[0];
}

static const char *word_of(enum cell_status status)
{
    static const char *const words[] = { "crash", "", "lost", "slow", "-", "refused" };
    return words[status];
}

// "0.0123"; "x 0.0123": it does not hold; "x slow"; "-".
static bool write_value(const struct cell *cell, int i, char *text, size_t size)
{
    const struct line *line = i < cell->count ? &cell->lines[i] : NULL;
    bool red = cell->status != CELL_LACKS && (line == NULL || !line->holds);
    if (cell->status == CELL_LACKS) {
        snprintf(text, size, "-");
    } else if (line != NULL && line->judged) {
        snprintf(text, size, "%s%.3g", red ? "x " : "", line->measured);
    } else {
        const char *word = word_of(cell->status);
        snprintf(text, size, "x %s", word[0] != '\0' ? word : "never");
    }
    return red;
}

void referee_print(FILE *file, const struct referee *r, int count, bool colour)
{
    for (int t = 0; t < count; t++) {
        const struct task *task = &r->tasks[t];
        const struct cell *lines = lines_of(r, task);
        char name[NAME_SIZE], text[32];
        if (t % 8 == 0) {
            fprintf(file, "%-46s %9s", "", "bound");
            for (int c = 0; c < r->contender_count; c++) {
                fprintf(file, " %10s", r->contenders[c]->key);
            }
            fprintf(file, "\n");
        }
        referee_name(task->path, name, sizeof name);
        fprintf(file, "%s\n", name);
        for (int i = 0; i < lines->count || i == 0; i++) {
            const struct line *line = &lines->lines[i];
            fprintf(file, "  %-44.44s %9.3g", line->name, line->limit);
            for (int c = 0; c < r->contender_count; c++) {
                bool red = write_value(&task->cells[c], i, text, sizeof text);
                const char *hue = text[0] == '-' ? "2" : red ? "31" : "32";
                fprintf(file, colour ? " \033[%sm%10.10s\033[0m" : "%.0s %10.10s", hue, text);
            }
            fprintf(file, "\n");
        }
    }
}

void referee_print_markdown(FILE *file, const struct referee *r, int count)
{
    fprintf(file, "| scene | expectation | bound |");
    for (int c = 0; c < r->contender_count; c++) {
        fprintf(file, " %s, %s |", r->contenders[c]->name, r->contenders[c]->way);
    }
    fprintf(file, "\n|---|---|---|");
    for (int c = 0; c < r->contender_count; c++) {
        fprintf(file, "---|");
    }
    fprintf(file, "\n");
    for (int t = 0; t < count; t++) {
        const struct task *task = &r->tasks[t];
        const struct cell *lines = lines_of(r, task);
        char name[NAME_SIZE], text[32];
        referee_name(task->path, name, sizeof name);
        for (int i = 0; i < lines->count || i == 0; i++) {
            const struct line *line = &lines->lines[i];
            fprintf(file, "| %s%s%s | %s | %.3g |", i == 0 ? "`" : "", i == 0 ? name : "",
                    i == 0 ? "`" : "", line->name, line->limit);
            for (int c = 0; c < r->contender_count; c++) {
                (void)write_value(&task->cells[c], i, text, sizeof text);
                fprintf(file, " %s |", text);
            }
            fprintf(file, "\n");
        }
    }
}

static void put_quoted(FILE *file, const char *text)
{
    fputc('"', file);
    for (; *text != '\0'; text++) {
        if (*text == '"') {
            fputc('"', file);
        }
        fputc((unsigned char)*text < 32 ? ' ' : *text, file);
    }
    fputc('"', file);
}

void referee_print_csv(FILE *file, const struct referee *r, int count)
{
    static const char *const states[] = { "crashed", "judged", "lost", "slow", "lacks", "refused" };
    fprintf(file, "scene,expectation,quantity,unit,bound,engine,settings,measured,time,holds,state,"
                  "reason\n");
    for (int t = 0; t < count; t++) {
        const struct task *task = &r->tasks[t];
        const struct cell *lines = lines_of(r, task);
        char name[NAME_SIZE];
        referee_name(task->path, name, sizeof name);
        for (int i = 0; i < (lines->count > 0 ? lines->count : 1) * r->contender_count; i++) {
            const struct contender *c = r->contenders[i % r->contender_count];
            const struct cell *cell = &task->cells[i % r->contender_count];
            int k = i / r->contender_count;
            const struct line *line = k < cell->count ? &cell->lines[k] : NULL;
            fprintf(file, "%s,", name);
            put_quoted(file, lines->lines[k].name);
            fprintf(file, ",%s,%s,%.9g,%s,\"%s\",", lines->lines[k].quantity, lines->lines[k].unit,
                    line != NULL && line->judged ? line->limit : lines->lines[k].limit, c->name,
                    c->way);
            if (line != NULL && line->judged) {
                fprintf(file, "%.9g,%.9g,%s,", line->measured, line->time,
                        line->holds ? "yes" : "no");
            } else {
                fprintf(file, ",,%s,", cell->status == CELL_LACKS ? "" : "no");
            }
            fprintf(file, "%s,", states[cell->status]);
            put_quoted(file, cell->reason);
            fprintf(file, "\n");
        }
    }
}

// ---------------------------------------------------------------------------------- summary

static void count_passes(const struct referee *r, int c, int count, int scenes[2], int lines[2])
{
    scenes[0] = scenes[1] = lines[0] = lines[1] = 0;
    for (int t = 0; t < count; t++) {
        const struct cell *cell = &r->tasks[t].cells[c];
        if (cell->status == CELL_LACKS) {
            continue;
        }
        scenes[1]++;
        scenes[0] += referee_holds(cell);
        lines[1] += lines_of(r, &r->tasks[t])->count;
        for (int i = 0; i < cell->count; i++) {
            lines[0] += cell->lines[i].holds && cell->status == CELL_JUDGED;
        }
    }
}

// Why an engine has no words for scenes, and for how many.
static void put_reasons(FILE *file, const struct referee *r, int c, int count)
{
    const char *reasons[REASONS_MAX];
    int times[REASONS_MAX] = { 0 }, known = 0;
    for (int t = 0; t < count; t++) {
        const struct cell *cell = &r->tasks[t].cells[c];
        int i = 0;
        while (i < known && strcmp(reasons[i], cell->reason) != 0) {
            i++;
        }
        if (cell->status == CELL_LACKS && i < REASONS_MAX) {
            reasons[i] = cell->reason;
            times[i]++;
            known = i == known ? known + 1 : known;
        }
    }
    for (int i = 0; i < known; i++) {
        fprintf(file, "%s%s (%d)", i > 0 ? "; " : "", reasons[i], times[i]);
    }
}

void referee_print_summary(FILE *file, const struct referee *r, int count, bool markdown)
{
    fprintf(file, markdown
                      ? "| engine | settings | scenes that hold whole | expectations that hold "
                        "| no words for |\n|---|---|---|---|---|\n"
                      : "\n");
    for (int c = 0; c < r->contender_count; c++) {
        int scenes[2], lines[2];
        count_passes(r, c, count, scenes, lines);
        fprintf(file,
                markdown ? "| %s | %s | %d of %d | %d of %d | "
                         : "%-14s %-34s passes %3d of %3d scenes, %3d of %3d expectations  ",
                r->contenders[c]->name, r->contenders[c]->way, scenes[0], scenes[1], lines[0],
                lines[1]);
        if (markdown) {
            put_reasons(file, r, c, count);
        }
        fprintf(file, markdown ? " |\n" : "\n");
    }
}

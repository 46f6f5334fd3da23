/// explain_flow.c - `plumb explain --flow FILE.svg`: the passes that ran as rows, the data that they name as columns. A ring
/// where a pass reads, a disc where it writes; a bar for its share of the time.
///
/// Reads a report, writes the file. Cost: O(passes x data).
#include "explain.h"

#include <string.h>

enum { DATA_MOST = 64, ROW = 22, COLUMN = 26, NAMES = 330, HEAD = 150, MARGIN = 24, BARS = 150 };

typedef struct flow {
    const explain_report *r;
    FILE *file;
    char names[DATA_MOST][48]; ///< of the columns
    int columns;
    const engine_pass *rows[256];
    int count;
} flow;

static bool names_it(const char *list, const char *name)
{
    const size_t length = strlen(name);
    for (const char *at = list; *at != '\0'; at += strcspn(at, ","), at += strspn(at, ", ")) {
        if (strcspn(at, ",") == length && memcmp(at, name, length) == 0) {
            return true;
        }
    }
    return false;
}

/// Columns in the order in which they are first named.
static void add_columns(flow *f, const char *list)
{
    for (const char *at = list; *at != '\0'; at += strspn(at, ", ")) {
        const size_t length = strcspn(at, ",");
        char name[48];
        int k = 0;
        snprintf(name, sizeof name, "%.*s", (int)length, at);
        while (k < f->columns && strcmp(f->names[k], name) != 0) {
            k++;
        }
        if (k == f->columns && f->columns < DATA_MOST) {
            memcpy(f->names[f->columns++], name, sizeof name);
        }
        at += length;
    }
}

static void collect(flow *f)
{
    for (int i = 0; i < f->r->count && f->count < 256; i++) {
        const engine_pass *pass = &f->r->list[i];
        if (explain_find(f->r->tally, pass)->steps > 0) {
            f->rows[f->count++] = pass;
            add_columns(f, pass->reads);
            add_columns(f, pass->writes);
        }
    }
}

static void escaped(FILE *file, const char *s)
{
    for (; *s != '\0'; s++) {
        switch (*s) {
        case '<':
            fputs("&lt;", file);
            break;
        case '>':
            fputs("&gt;", file);
            break;
        case '&':
            fputs("&amp;", file);
            break;
        default:
            fputc((unsigned char)*s < 32 ? ' ' : *s, file);
        }
    }
}

static int column_x(int column)
{
    return MARGIN + NAMES + column * COLUMN + COLUMN / 2;
}

static int row_y(int row)
{
    return MARGIN + HEAD + row * ROW + ROW / 2;
}

static void draw_text(const flow *f, int x, int y, const char *style, const char *s)
{
    fprintf(f->file, "<text x=\"%d\" y=\"%d\" %s>", x, y, style);
    escaped(f->file, s);
    fputs("</text>\n", f->file);
}

/// From the first row that names a column to the last one.
static void draw_column(const flow *f, int column)
{
    int first = -1, last = -1;
    for (int i = 0; i < f->count; i++) {
        if (names_it(f->rows[i]->reads, f->names[column]) ||
            names_it(f->rows[i]->writes, f->names[column])) {
            first = first < 0 ? i : first;
            last = i;
        }
    }
    const int x = column_x(column);
    fprintf(
        f->file,
        "<line x1=\"%d\" y1=\"%d\" x2=\"%d\" y2=\"%d\" stroke=\"#cbc7bf\" stroke-width=\"2\"/>\n",
        x, row_y(first), x, row_y(last));
    fprintf(f->file, "<text transform=\"translate(%d,%d) rotate(-50)\">", x + 4, MARGIN + HEAD - 6);
    escaped(f->file, f->names[column]);
    fputs("</text>\n", f->file);
}

static void draw_row(const flow *f, int row)
{
    const engine_pass *pass = f->rows[row];
    const engine_because *b = &explain_find(f->r->tally, pass)->because;
    const int y = row_y(row), right = MARGIN + NAMES + f->columns * COLUMN + 16;
    char visited[64] = "";
    if (row % 2 == 1) {
        fprintf(f->file,
                "<rect x=\"%d\" y=\"%d\" width=\"%d\" height=\"%d\" fill=\"#000\" "
                "fill-opacity=\"0.035\"/>\n",
                MARGIN, y - ROW / 2, NAMES + f->columns * COLUMN + BARS + 16, ROW);
    }
    draw_text(f, MARGIN + 8 + (pass->in_substeps ? 18 : 0), y + 4,
              pass->is_user ? "font-style=\"italic\"" : "", pass->name);
    if (b->rows >= 0) {
        snprintf(visited, sizeof visited, "%ld %s", b->rows, b->what);
    }
    draw_text(f, MARGIN + NAMES - 14, y + 4, "text-anchor=\"end\" fill=\"#8a857c\"", visited);
    if (f->r->total > 0) {
        const double share = pass->total_ns / f->r->total;
        char percent[32];
        snprintf(percent, sizeof percent, "%.1f %%", 100 * share);
        fprintf(
            f->file,
            "<rect x=\"%d\" y=\"%d\" width=\"%.1f\" height=\"10\" rx=\"2\" fill=\"#8fae8b\"/>\n",
            right, y - 5, 1 + share * (BARS - 60));
        draw_text(f, right + 6 + (int)(share * (BARS - 60)), y + 4, "fill=\"#8a857c\"", percent);
    }
}

static void draw_marks(const flow *f, int row)
{
    for (int k = 0; k < f->columns; k++) {
        const bool reads = names_it(f->rows[row]->reads, f->names[k]);
        const bool writes = names_it(f->rows[row]->writes, f->names[k]);
        if (writes) {
            fprintf(f->file, "<circle cx=\"%d\" cy=\"%d\" r=\"5\" fill=\"#c8623c\"/>\n",
                    column_x(k), row_y(row));
        }
        if (reads) {
            fprintf(f->file,
                    "<circle cx=\"%d\" cy=\"%d\" r=\"%d\" fill=\"%s\" stroke=\"#3f76a8\" "
                    "stroke-width=\"2\"/>\n",
                    column_x(k), row_y(row), writes ? 7 : 5, writes ? "none" : "#fbfaf7");
        }
    }
}

static void draw_key(const flow *f, int y)
{
    const int x = MARGIN + 8;
    fprintf(f->file,
            "<circle cx=\"%d\" cy=\"%d\" r=\"5\" fill=\"#fbfaf7\" stroke=\"#3f76a8\" "
            "stroke-width=\"2\"/>\n",
            x + 5, y);
    draw_text(f, x + 18, y + 4, "", "reads");
    fprintf(f->file, "<circle cx=\"%d\" cy=\"%d\" r=\"5\" fill=\"#c8623c\"/>\n", x + 75, y);
    draw_text(f, x + 88, y + 4, "", "writes");
    draw_text(f, x + 145, y + 4, "fill=\"#8a857c\"", "rows set in run in each substep");
}

static void draw(flow *f)
{
    const int bars = f->r->total > 0 ? BARS : 0;
    const int width = 2 * MARGIN + NAMES + f->columns * COLUMN + 16 + bars + 40,
              height = 2 * MARGIN + HEAD + f->count * ROW + 34;
    fprintf(f->file,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%d\" height=\"%d\" viewBox=\"0 0 %d "
            "%d\" "
            "font-family=\"DejaVu Sans, Verdana, sans-serif\" font-size=\"12\" fill=\"#33312e\">\n"
            "<rect width=\"100%%\" height=\"100%%\" fill=\"#fbfaf7\"/>\n",
            width, height, width, height);
    draw_text(f, MARGIN + 8, MARGIN + 18, "font-size=\"18\"", f->r->run->info.name);
    draw_text(f, MARGIN + 8, MARGIN + 38, "fill=\"#8a857c\"",
              "passes from top to bottom, and the data that they name");
    for (int i = 0; i < f->count; i++) {
        draw_row(f, i);
    }
    for (int k = 0; k < f->columns; k++) {
        draw_column(f, k);
    }
    for (int i = 0; i < f->count; i++) {
        draw_marks(f, i);
    }
    draw_key(f, row_y(f->count) + 14);
    fputs("</svg>\n", f->file);
}

bool explain_flow_names(const char *path)
{
    const size_t length = strlen(path);
    const bool good = length > 4 && strcmp(path + length - 4, ".svg") == 0;
    if (!good) {
        cli_message("--flow is '%s'; it must be the name of a file that ends in .svg", path);
    }
    return good;
}

int explain_flow(const explain_report *report, const char *path)
{
    flow f = { .r = report };
    cli_output out;
    const int code = cli_output_open(&out, path);
    if (code != CLI_OK) {
        return code;
    }
    f.file = out.file;
    collect(&f);
    draw(&f);
    return cli_output_close(&out, true);
}

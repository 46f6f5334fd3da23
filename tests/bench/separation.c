// separation.c - the hinges' referee. Reads: the scene, poses. Writes: its result.
#include "separation.h"

#include <math.h>

// Where the point of the body that was at (x, y) when the body was made is now.
static void carry(const struct engine_body_def *made, struct engine_pose now, double *x, double *y)
{
    double c = cos(made->angle);
    double s = sin(made->angle);
    double dx = *x - made->x;
    double dy = *y - made->y;
    double local_x = c * dx + s * dy;
    double local_y = c * dy - s * dx;
    *x = now.x + now.c * local_x - now.s * local_y;
    *y = now.y + now.s * local_x + now.c * local_y;
}

struct separation separation_measure(const struct scene *scene, const struct engine_pose *poses,
                                     int step)
{
    struct separation result = { 0.0, 0.0, 0 };
    for (int i = 0; i < scene->hinge_count; ++i) {
        const struct engine_hinge_def *h = &scene->hinges[i];
        if (!scene_has(scene, h->body_a, step) || !scene_has(scene, h->body_b, step)) {
            continue;
        }
        double ax = h->x;
        double ay = h->y;
        double bx = h->x;
        double by = h->y;
        carry(&scene->bodies[h->body_a].def, poses[h->body_a], &ax, &ay);
        carry(&scene->bodies[h->body_b].def, poses[h->body_b], &bx, &by);
        double apart = hypot(bx - ax, by - ay);
        if (isfinite(apart)) { // else its body counts as astray
            result.sum += apart;
            result.max = fmax(result.max, apart);
            ++result.hinges;
        }
    }
    return result;
}

/// scenes.h - build functions of the scenes that stand in files of their own.
#ifndef BENCH_SCENES_H
#define BENCH_SCENES_H

#include "scene.h"

void build_tumbler(struct scene *scene);
void build_joint_grid(struct scene *scene);
void build_spinner(struct scene *scene);
void build_rain(struct scene *scene);
void build_odd_columns(struct scene *scene);
void build_odd_mixed(struct scene *scene);
void build_odd_bounce(struct scene *scene);
void build_odd_balls(struct scene *scene);
void build_odd_gas(struct scene *scene);
void build_odd_tiles(struct scene *scene);
void build_odd_hills(struct scene *scene);
void build_odd_flails(struct scene *scene);
void build_odd_sizes(struct scene *scene);

#endif

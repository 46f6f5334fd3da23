// getters.h - the questions that one handle is asked, as lists: X(name, answer), where `w` is the world, `h` the
// handle and `point` some point. Of an answer of several members it is one, or whether it is null.
// test_api_getters.c fails for a getter of the headers that is in no list.
#ifndef GETTERS_H
#define GETTERS_H

// clang-format off
#define BODY_GETTERS(X)                                                                             \
    X(plumb_body_get_type, (int)plumb_body_get_type(w, h))                                          \
    X(plumb_body_is_enabled, plumb_body_is_enabled(w, h))                                           \
    X(plumb_body_position, plumb_body_position(w, h))                                               \
    X(plumb_body_center, plumb_body_center(w, h))                                                   \
    X(plumb_body_angle, plumb_body_angle(w, h))                                                     \
    X(plumb_body_transform, plumb_body_transform(w, h))                                             \
    X(plumb_body_velocity, plumb_body_velocity(w, h))                                               \
    X(plumb_body_angular_velocity, plumb_body_angular_velocity(w, h))                               \
    X(plumb_body_velocity_at, plumb_body_velocity_at(w, h, point))                                  \
    X(plumb_body_mass, plumb_body_mass(w, h))                                                       \
    X(plumb_body_inertia, plumb_body_inertia(w, h))                                                 \
    X(plumb_body_local_center, plumb_body_local_center(w, h))                                       \
    X(plumb_body_has_target, plumb_body_has_target(w, h))                                           \
    X(plumb_body_force, plumb_body_force(w, h))                                                     \
    X(plumb_body_torque, plumb_body_torque(w, h))                                                   \
    X(plumb_body_is_continuous, plumb_body_is_continuous(w, h))                                     \
    X(plumb_body_locks, plumb_body_locks(w, h).x)                                                   \
    X(plumb_body_damping, plumb_body_damping(w, h))                                                 \
    X(plumb_body_angular_damping, plumb_body_angular_damping(w, h))                                 \
    X(plumb_body_max_speed, plumb_body_max_speed(w, h))                                             \
    X(plumb_body_max_spin, plumb_body_max_spin(w, h))                                               \
    X(plumb_body_charge, plumb_body_charge(w, h))                                                   \
    X(plumb_body_attraction, plumb_body_attraction(w, h))                                           \
    X(plumb_body_dipole, plumb_body_dipole(w, h))                                                   \
    X(plumb_body_dipole_angle, plumb_body_dipole_angle(w, h))                                       \
    X(plumb_body_drag, plumb_body_drag(w, h))                                                       \
    X(plumb_body_thrust, plumb_body_thrust(w, h)) \
    X(plumb_body_exhaust, plumb_body_exhaust(w, h)) \
    X(plumb_body_fuel, plumb_body_fuel(w, h)) \
    X(plumb_body_thrust_x, plumb_body_thrust_x(w, h)) \
    X(plumb_body_thrust_y, plumb_body_thrust_y(w, h)) \
    X(plumb_body_thrust_angle, plumb_body_thrust_angle(w, h)) \
    X(plumb_body_temperature, plumb_body_temperature(w, h)) \
    X(plumb_body_heat_capacity, plumb_body_heat_capacity(w, h)) \
    X(plumb_body_conductance, plumb_body_conductance(w, h)) \
    X(plumb_body_emissivity, plumb_body_emissivity(w, h)) \
    X(plumb_body_ambient, plumb_body_ambient(w, h)) \
    X(plumb_body_heating, plumb_body_heating(w, h)) \
    X(plumb_body_melting_point, plumb_body_melting_point(w, h)) \
    X(plumb_body_latent_heat, plumb_body_latent_heat(w, h)) \
    X(plumb_body_melt_phase, plumb_body_melt_phase(w, h)) \
    X(plumb_body_ignition, plumb_body_ignition(w, h)) \
    X(plumb_body_burn_rate, plumb_body_burn_rate(w, h)) \
    X(plumb_body_burn_heat, plumb_body_burn_heat(w, h)) \
    X(plumb_body_growth, plumb_body_growth(w, h)) \
    X(plumb_body_smallest, plumb_body_smallest(w, h)) \
    X(plumb_body_time_scale, plumb_body_time_scale(w, h))                                           \
    X(plumb_body_gravity_scale, plumb_body_gravity_scale(w, h))                                     \
    X(plumb_body_user_data, plumb_body_user_data(w, h))                                             \
    X(plumb_body_shapes, plumb_body_shapes(w, h, NULL, 0))                                          \
    X(plumb_body_kinetic_energy, plumb_body_kinetic_energy(w, h))                                   \
    X(plumb_body_aabb, plumb_body_aabb(w, h))                                                       \
    X(plumb_body_world_point, plumb_body_world_point(w, h, point))                                  \
    X(plumb_body_local_point, plumb_body_local_point(w, h, point))                                  \
    X(plumb_body_world_vector, plumb_body_world_vector(w, h, point))                                \
    X(plumb_body_local_vector, plumb_body_local_vector(w, h, point))                                \
    X(plumb_body_is_character, plumb_body_is_character(w, h))                                       \
    X(plumb_body_is_awake, plumb_body_is_awake(w, h))                                               \
    X(plumb_body_no_sleep, plumb_body_no_sleep(w, h))                                               \
    X(plumb_body_contacts, plumb_body_contacts(w, h, NULL, 0))                                      \
    X(plumb_body_joints, plumb_body_joints(w, h, NULL, 0))                                          \
    X(plumb_world_is_excluded, plumb_world_is_excluded(w, h, h))
#define SHAPE_GETTERS(X)                                                                            \
    X(plumb_shape_get_kind, (int)plumb_shape_get_kind(w, h))                                        \
    X(plumb_shape_body, plumb_is_null(plumb_shape_body(w, h)))                                      \
    X(plumb_shape_material, plumb_is_null(plumb_shape_material(w, h)))                              \
    X(plumb_shape_density, plumb_shape_density(w, h))                                               \
    X(plumb_shape_mass, plumb_shape_mass(w, h))                                                     \
    X(plumb_shape_user_data, plumb_shape_user_data(w, h))                                           \
    X(plumb_shape_filter, plumb_shape_filter(w, h).nothing)                                         \
    X(plumb_shape_one_way, plumb_shape_one_way(w, h))                                               \
    X(plumb_shape_is_sensor, plumb_shape_is_sensor(w, h))                                           \
    X(plumb_shape_piece_count, plumb_shape_piece_count(w, h))                                       \
    X(plumb_shape_aabb, plumb_shape_aabb(w, h))                                                     \
    X(plumb_shape_contains, plumb_shape_contains(w, h, point))
#define JOINT_GETTERS(X)                                                                            \
    X(plumb_joint_is_enabled, plumb_joint_is_enabled(w, h))                                         \
    X(plumb_joint_get_kind, (int)plumb_joint_get_kind(w, h))                                        \
    X(plumb_joint_body_a, plumb_is_null(plumb_joint_body_a(w, h)))                                  \
    X(plumb_joint_body_b, plumb_is_null(plumb_joint_body_b(w, h)))                                  \
    X(plumb_joint_anchor_a, plumb_joint_anchor_a(w, h))                                             \
    X(plumb_joint_anchor_b, plumb_joint_anchor_b(w, h))                                             \
    X(plumb_joint_value, plumb_joint_value(w, h))                                                   \
    X(plumb_joint_error, plumb_joint_error(w, h))                                                   \
    X(plumb_joint_rate, plumb_joint_rate(w, h))                                                     \
    X(plumb_joint_turn_rate, plumb_joint_turn_rate(w, h))                                           \
    X(plumb_joint_travel_rate, plumb_joint_travel_rate(w, h))                                       \
    X(plumb_joint_force, plumb_joint_force(w, h))                                                   \
    X(plumb_joint_torque, plumb_joint_torque(w, h))                                                 \
    X(plumb_joint_impulse, plumb_joint_impulse(w, h))                                               \
    X(plumb_joint_angular_impulse, plumb_joint_angular_impulse(w, h))                               \
    X(plumb_joint_user_data, plumb_joint_user_data(w, h))
// clang-format on

#endif

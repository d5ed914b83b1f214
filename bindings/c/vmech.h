/* The C interface of vmech: mechanisms, the loads of their joints, poses and a mechanism in a hand.
 * C99, and C++. docs/c.md has programs.
 *
 * Handles. What begins with vmech_mechanism, vmech_study, vmech_result and vmech_tick is made by a
 * function of the library and given back to its _free, which takes NULL. A function that makes one
 * always returns a handle, NULL only where memory is out: if it failed, the handle holds the status
 * and a message that says what is wrong, where, and what to do. A handle made of a failed one fails
 * with the same message, so that a program may ask the last one alone. NULL is taken for a handle
 * that has failed by want of memory. A handle keeps no other alive and needs none.
 *
 * Threads. There is no global state. Functions that take a `const` handle may be called from
 * several threads at once on the same one; others from one thread at a time for each handle, and
 * not while another thread reads it. Of the same handle a message, a name or an array stays where
 * it is until the handle is changed or freed.
 *
 * Units and frames. Metres, radians, kilograms, seconds, newtons. World axes are the drawing axes
 * of the ground link. A wrench is [fx fy fz mx my mz]. That of a joint is what its first link
 * exerts on its second, about the second anchor's origin, in the axes of the first anchor. Freedoms
 * are those of all joints in their order, a spherical joint has three (the rotation vector).
 *
 * Structures but vmech_pose and vmech_anchor begin with `struct_size`, sizeof of the structure as
 * the program was compiled with it: fields that a later version adds count as zero, their default.
 */
#pragma once

#include <stddef.h>
#include <stdint.h>

#if defined(__GNUC__)
#define VMECH_API __attribute__((visibility("default")))
#else
#define VMECH_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* What came of a call. */
typedef int32_t vmech_status;
enum {
  VMECH_OK = 0,
  VMECH_FILE_ERROR = 1,    /* a file or a text is wrong or cannot be read; the message has lines */
  VMECH_INVALID = 2,       /* an argument contradicts itself or others, or is out of its range */
  VMECH_NO_SOLUTION = 3,   /* loops do not close, a motion cannot be followed, a run has failed */
  VMECH_OUT_OF_MEMORY = 4, /* no memory is left, or a handle is NULL */
  VMECH_INTERRUPTED = 5,   /* the program's `progress` returned 0 */
  VMECH_INTERNAL = 6       /* a defect of the library; the message says which */
};

/* A mechanism, read or built. */
typedef struct vmech_mechanism vmech_mechanism;
/* A mechanism, its motion, and what loads it. */
typedef struct vmech_study vmech_study;
/* What a run came to. */
typedef struct vmech_result vmech_result;
/* A mechanism in a hand. */
typedef struct vmech_tick vmech_tick;

/* The pose of a frame in another one. */
typedef struct vmech_pose {
  double position[3]; /* of its origin [m] */
  double rotation[9]; /* R [3, 3], row after row; its columns are the axes of the frame */
} vmech_pose;

/* The version of the library, "0.2.0". Its soname changes where a program has to be compiled
 * anew. */
VMECH_API const char* vmech_version(void);

/* ---- Mechanisms ---- */

/* How a file is read. */
typedef struct vmech_read_options {
  size_t struct_size; /* sizeof(vmech_read_options) */
  /* [setting_count] values of parameters, "crank=60" or "load=1 kN", which go before those of the
   * file; numbers without a unit count in the units of the file. */
  const char* const* settings;
  size_t setting_count; /* of settings */
} vmech_read_options;
/* From a file (docs/file-format.md). */
VMECH_API vmech_mechanism* vmech_mechanism_open(const char* path);
/* The same with options; NULL: none. */
VMECH_API vmech_mechanism* vmech_mechanism_open_with(const char* path,
                                                     const vmech_read_options* options);
/* From a text; `name` stands for the file in messages. */
VMECH_API vmech_mechanism* vmech_mechanism_parse(const char* text, const char* name);
/* The same with options; NULL: none. */
VMECH_API vmech_mechanism* vmech_mechanism_parse_with(const char* text, const char* name,
                                                      const vmech_read_options* options);
/* An empty one, to be built by the functions below; its first link is the ground. */
VMECH_API vmech_mechanism* vmech_mechanism_new(const char* name);
/* Gives it back; NULL is allowed. */
VMECH_API void vmech_mechanism_free(vmech_mechanism* mechanism);
/* The status of the handle. */
VMECH_API vmech_status vmech_mechanism_status(const vmech_mechanism* mechanism);
/* What the handle says of its status. */
VMECH_API const char* vmech_mechanism_message(const vmech_mechanism* mechanism);

/* Building. Each returns the index of what it added; -1, and the handle fails, if that is not
 * possible. Springs, friction, limits and stiffnesses are for the file format, as text. */
typedef struct vmech_link {
  size_t struct_size; /* sizeof(vmech_link) */
  const char* name;   /* unique in the mechanism */
  double mass;        /* [kg] */
  double center[3];   /* centre of gravity in the drawing frame [m] */
  double inertia[6];  /* xx yy zz xy xz yz, of the matrix about it, drawing axes [kg m^2] */
} vmech_link;
/* Adds a link; the first is the ground. */
VMECH_API int32_t vmech_add_link(vmech_mechanism* mechanism, const vmech_link* link);

/* A frame on a link, in the link's drawing frame. `z` and `x` need not be of length 1; x is made
 * square to z. A zero `x`: any direction across z; a zero `z`: that of the drawing; both zero: the
 * drawing axes. */
typedef struct vmech_anchor {
  int32_t link;      /* index of the link */
  double origin[3];  /* in the drawing frame [m] */
  double z[3], x[3]; /* directions in the drawing frame */
} vmech_anchor;

/* Which freedoms a joint has, in their order. */
typedef int32_t vmech_joint_type;
enum {
  VMECH_REVOLUTE = 0,    /* about z */
  VMECH_PRISMATIC = 1,   /* along z */
  VMECH_CYLINDRICAL = 2, /* along z, about z */
  VMECH_SCREW = 3,       /* about z, with `pitch` along z */
  VMECH_UNIVERSAL = 4,   /* about x of the first anchor, then about y of the second */
  VMECH_SPHERICAL = 5,
  VMECH_PLANAR = 6, /* along x and y of the first anchor, then about z */
  VMECH_WELD = 7
};
/* A joint between anchors of two links. */
typedef struct vmech_joint {
  size_t struct_size;         /* sizeof(vmech_joint) */
  const char* name;           /* unique in the mechanism */
  vmech_joint_type type;      /* decides its freedoms */
  vmech_anchor first, second; /* they coincide where the joint's coordinates are zero */
  double pitch;               /* VMECH_SCREW: travel [m/rad] */
  /* Where the assembly starts, a value per freedom; NULL: anywhere. Of a spherical joint four, a
   * unit quaternion w x y z. */
  const double* start;
} vmech_joint;
/* Adds a joint. */
VMECH_API int32_t vmech_add_joint(vmech_mechanism* mechanism, const vmech_joint* joint);
/* A frame by which a hand holds the mechanism; `is_point`: by its position alone. */
VMECH_API int32_t vmech_add_grasp(vmech_mechanism* mechanism, const char* name,
                                  const vmech_anchor* frame, int32_t is_point);
/* Gravity in the axes of the ground [m/s^2]. */
VMECH_API vmech_status vmech_set_gravity(vmech_mechanism* mechanism, const double gravity[3]);

/* What a mechanism has several of. */
typedef int32_t vmech_item;
enum { VMECH_LINKS = 0, VMECH_JOINTS = 1, VMECH_GRASPS = 2, VMECH_FREEDOMS = 3 };
/* How many there are; 0 of a failed mechanism. */
VMECH_API size_t vmech_mechanism_count(const vmech_mechanism* mechanism, vmech_item item);
/* "crank"; a freedom is "pin", or "ball.rx" of a joint with several. NULL beyond the last. */
VMECH_API const char* vmech_mechanism_name(const vmech_mechanism* mechanism, vmech_item item,
                                           size_t index);
/* The index of a name; -1 if there is none. */
VMECH_API int32_t vmech_mechanism_find(const vmech_mechanism* mechanism, vmech_item item,
                                       const char* name);

/* A parameter of a file, and what it is after all settings. */
typedef struct vmech_parameter {
  size_t struct_size; /* sizeof(vmech_parameter) */
  const char* name;   /* as in the file */
  const char* unit;   /* "mm", or that of the setting; empty for a plain number */
  double value;       /* in the unit */
} vmech_parameter;
/* The parameters of the file in its order; VMECH_INVALID beyond the last. */
VMECH_API vmech_status vmech_mechanism_parameter(const vmech_mechanism* mechanism, size_t index,
                                                 vmech_parameter* parameter);

/* ---- Studies ---- */

/* From a file (docs/study-format.md) and those that it names. */
VMECH_API vmech_study* vmech_study_open(const char* path);
/* The same with options; NULL: none. Settings are of parameters of the mechanism or the study. */
VMECH_API vmech_study* vmech_study_open_with(const char* path, const vmech_read_options* options);
/* Of a mechanism, at rest at time 0 and without loads but its weight, to be added to. */
VMECH_API vmech_study* vmech_study_new(const vmech_mechanism* mechanism);
/* Gives it back; NULL is allowed. */
VMECH_API void vmech_study_free(vmech_study* study);
/* The status of the handle. */
VMECH_API vmech_status vmech_study_status(const vmech_study* study);
/* What the handle says of its status. */
VMECH_API const char* vmech_study_message(const vmech_study* study);
/* A copy of the study's mechanism, with the parameters of the study. */
VMECH_API vmech_mechanism* vmech_study_mechanism(const vmech_study* study);
/* The parameters of the mechanism, then those of the study; VMECH_INVALID beyond the last. */
VMECH_API vmech_status vmech_study_parameter(const vmech_study* study, size_t index,
                                             vmech_parameter* parameter);

/* A motor: one freedom of a joint moves as prescribed, whatever force that takes. With a table, by
 * the cubic spline through it; without, start + speed t + acceleration t^2 / 2. */
typedef struct vmech_drive {
  size_t struct_size;                /* sizeof(vmech_drive) */
  int32_t joint, freedom;            /* indices; freedoms count from 0 */
  double start, speed, acceleration; /* [m, m/s, m/s^2] or [rad, rad/s, rad/s^2] */
  size_t rows;                       /* of the table; 0: there is none */
  const double* times;               /* [rows] increasing [s] */
  const double* values;              /* [rows] coordinate [m] or [rad] */
} vmech_drive;
/* Adds a motor. */
VMECH_API vmech_status vmech_study_add_drive(vmech_study* study, const vmech_drive* drive);
/* The times of the poses [s], increasing. `cycle`: the motion repeats after it [s]; 0: it does
 * not. */
VMECH_API vmech_status vmech_study_set_times(vmech_study* study, const double* times, size_t count,
                                             double cycle);
/* A constant wrench [N, N m] on a link, about a point of it in its drawing frame [m]; in the axes
 * of the world, or of the link where `in_link_axes` is not 0. */
VMECH_API vmech_status vmech_study_add_load(vmech_study* study, int32_t link, const double point[3],
                                            const double wrench[6], int32_t in_link_axes);

/* ---- Results ---- */

/* How a study is run. */
typedef struct vmech_run_options {
  size_t struct_size; /* sizeof(vmech_run_options) */
  int32_t threads;    /* 1 to 64; 0 is 1. The result does not depend on it */
  /* Called now and then, from the calling thread or one of these, with the number of poses done;
   * 0 stops. NULL: nobody asks. */
  int32_t (*progress)(void* user, size_t poses);
  void* user; /* is handed to `progress` */
} vmech_run_options;
/* Runs the loads, or the simulation, and chooses bearings. `options` may be NULL. A simulation that
 * stops early has VMECH_NO_SOLUTION or VMECH_INTERRUPTED, and what it had computed. */
VMECH_API vmech_result* vmech_study_run(const vmech_study* study, const vmech_run_options* options);

/* The hand, and the solver that looks for the nearest pose. */
typedef struct vmech_ik_options {
  size_t struct_size;    /* sizeof(vmech_ik_options) */
  int32_t grasp;         /* index of the grasp by which the hand holds */
  vmech_pose hand;       /* in the world; of a point grasp the position counts */
  double stiffness[6];   /* weighs positions [N/m] and rotations [N m/rad]; all 0: the default */
  int32_t ignore_limits; /* 1: limits of joints do not hold */
  const char* solver;    /* as `vmech ik --solver`; NULL: "nullspace" */
} vmech_ik_options;
/* The pose nearest to a hand, loops closed, from the mechanism's start: a result of one pose with
 * VMECH_POSITIONS, VMECH_LINK_POSITIONS, VMECH_LINK_ROTATIONS and VMECH_HAND_ERRORS. A hand out of
 * reach is no failure: see the last of these. */
VMECH_API vmech_result* vmech_ik(const vmech_mechanism* mechanism, const vmech_ik_options* options);

/* What a search for assembly modes holds, and how long it searches. */
typedef struct vmech_modes_options {
  size_t struct_size;           /* sizeof(vmech_modes_options) */
  const int32_t* held;          /* [held_count] indices of freedoms that stay as they start */
  size_t held_count;            /* how many are held */
  int32_t with_hand;            /* 1: a grasp has to be exactly at the hand; 0: there is no hand */
  int32_t grasp;                /* index of that grasp */
  vmech_pose hand;              /* in the world */
  int32_t ignore_limits;        /* 1: limits of joints do not hold */
  int32_t max_starts, patience; /* of the search; 0: 20000 and 2000 */
  uint64_t seed;                /* of the random starts; 0 is 1 */
} vmech_modes_options;
/* All assembly modes as a result of so many poses, as vmech_ik but without errors. `options` may be
 * NULL. */
VMECH_API vmech_result* vmech_assembly_modes(const vmech_mechanism* mechanism,
                                             const vmech_modes_options* options);

/* Gives it back; NULL is allowed. */
VMECH_API void vmech_result_free(vmech_result* result);
/* The status of the handle. */
VMECH_API vmech_status vmech_result_status(const vmech_result* result);
/* What the handle says of its status. */
VMECH_API const char* vmech_result_message(const vmech_result* result);
/* What a user should know, a sentence each; NULL beyond the last. */
VMECH_API const char* vmech_result_warning(const vmech_result* result, size_t index);

/* What a result holds arrays of. */
typedef int32_t vmech_quantity;
enum {
  VMECH_TIMES = 0,           /* [poses] [s] */
  VMECH_WRENCHES = 1,        /* [poses, joints, 6] [N], [N m] */
  VMECH_POSITIONS = 2,       /* [poses, freedoms] coordinates [m] or [rad] */
  VMECH_RATES = 3,           /* [poses, freedoms]; of a spherical joint the angular velocity of the
                              * second anchor in the first, in axes of the second [rad/s] */
  VMECH_ACCELERATIONS = 4,   /* [poses, freedoms] slopes of the rates */
  VMECH_DRIVE_MOTIONS = 5,   /* [poses, drives, 3] position, velocity, acceleration */
  VMECH_DRIVE_FORCES = 6,    /* [poses, drives] [N] or [N m] */
  VMECH_POWERS = 7,          /* [poses] of drives and hand [W] */
  VMECH_POWER_ERRORS = 8,    /* [poses] power in, less energy gained and lost, relative */
  VMECH_CLOSURES = 9,        /* [poses] loop error that is left, dimensionless */
  VMECH_LINK_POSITIONS = 10, /* [poses, links, 3] origins of the drawing frames in the world [m] */
  VMECH_LINK_ROTATIONS = 11, /* [poses, links, 3, 3] R of these frames, axes as columns */
  VMECH_LINK_TWISTS = 12,    /* [poses, links, 6] velocity of the drawing frame's origin, angular
                              * velocity, world axes */
  VMECH_HAND_WRENCHES = 13,  /* [poses, 6] of the hand on the mechanism about the grasp's origin,
                              * world axes */
  VMECH_HAND_ERRORS = 14,    /* [poses, 6] of vmech_ik: from the grasp to the hand [m], [rad], world
                              * axes */
  VMECH_ENERGIES = 15,       /* [poses, 6] of a simulation: kinetic, weight, springs, supplied,
                              * dissipated, error [J] */
  VMECH_MOTOR_FORCES = 16,   /* [poses, motors] of a simulation [N] or [N m] */
  VMECH_PEAKS = 17           /* [joints, 6] the largest size of every component of the wrenches */
};
/* Numbers of a result where they lie: that of the indices i, j, .. is
 * *(const double*)((const char*)data + i strides[0] + j strides[1] + ..). All but
 * VMECH_LINK_... and VMECH_HAND_WRENCHES lie one behind the other, the last index fastest. */
typedef struct vmech_array {
  size_t struct_size;   /* sizeof(vmech_array) */
  const double* data;   /* NULL where the result has no such array */
  size_t rank;          /* 1 to 4 */
  size_t shape[4];      /* the first `rank` of them */
  ptrdiff_t strides[4]; /* [bytes] */
} vmech_array;
/* An array of a result, where it lies. */
VMECH_API vmech_status vmech_result_array(const vmech_result* result, vmech_quantity quantity,
                                          vmech_array* array);
/* The same numbers into memory of the caller, whose strides [bytes] are `strides`, one for each
 * index; NULL: one behind the other. */
VMECH_API vmech_status vmech_result_copy(const vmech_result* result, vmech_quantity quantity,
                                         double* to, const ptrdiff_t* strides);

/* Whether statics determines a component of a wrench. */
typedef int32_t vmech_certainty;
enum {
  VMECH_CERTAIN = 0,
  VMECH_NOT_DETERMINED = 1, /* rigid links in equilibrium allow any value: a rule settled it */
  VMECH_SINGULAR = 2        /* grows without bound at every pose */
};
/* The verdict on one component, 0 to 5, of a joint's wrench; -1 beyond the last. */
VMECH_API vmech_certainty vmech_result_certainty(const vmech_result* result, size_t joint,
                                                 size_t component);

/* The bearings of a joint that the study asks for, one or two. */
typedef struct vmech_bearings {
  size_t struct_size;         /* sizeof(vmech_bearings) */
  int32_t joint;              /* index of the joint */
  int32_t is_met;             /* 1: every position has a bearing, and they live as long as asked */
  int32_t is_certain;         /* 1: statics determines what loads them */
  int32_t count;              /* of positions, 1 or 2 */
  double life_hours;          /* of all together at that reliability [h]; 0: one is missing */
  const char* designation[2]; /* chosen, or what came closest; NULL without any */
  double bearing_hours[2];    /* life of each at the required reliability [h] */
  double static_safety[2];    /* C0 / P0 of each */
} vmech_bearings;
/* The bearings of the study's entry `index`; VMECH_INVALID beyond the last. */
VMECH_API vmech_status vmech_result_bearings(const vmech_result* result, size_t index,
                                             vmech_bearings* bearings);

/* ---- A mechanism in a hand, for loops of a kHz ---- */

/* What couples hand and mechanism, and how often. */
typedef struct vmech_tick_options {
  size_t struct_size;  /* sizeof(vmech_tick_options) */
  int32_t grasp;       /* index of the grasp by which the hand holds */
  double period;       /* between two ticks [s], in [1e-7, 0.05] */
  double stiffness[6]; /* of the spring as the hand feels it [N/m], [N m/rad], along world axes */
  double damping[6];   /* of a damper beside it [N s/m], [N m s/rad] */
  double max_force;    /* the spring slips beyond this force [N]; 0: never */
  double max_moment;   /* the same of the moment [N m]; 0: never */
  double scale;        /* force at the hand over force at the mechanism, in [1e-6, 1e3]; 0 is 1 */
} vmech_tick_options;
/* The mechanism moves by its own dynamics, and the hand holds its grasp by a spring and a damper.
 * It starts assembled, where the mechanism starts, at rest. */
VMECH_API vmech_tick* vmech_tick_new(const vmech_mechanism* mechanism,
                                     const vmech_tick_options* options);
/* Gives it back; NULL is allowed. */
VMECH_API void vmech_tick_free(vmech_tick* tick);
/* The status of the handle. */
VMECH_API vmech_status vmech_tick_status(const vmech_tick* tick);
/* What the handle says of its status. */
VMECH_API const char* vmech_tick_message(const vmech_tick* tick);
/* One period with the hand at a pose in the world. Writes what the hand is to feel [N, N m], about
 * the hand's origin, world axes. No memory, lock or system call. VMECH_NO_SOLUTION, and a wrench of
 * zero, where there is no sound one: the program stops its motors. Any other failure (a handle that
 * has failed, NULL) leaves `wrench` as it was: the program must not send it. */
VMECH_API vmech_status vmech_tick_step(vmech_tick* tick, const vmech_pose* hand, double wrench[6]);
/* The grasp frame now, in the world. */
VMECH_API vmech_status vmech_tick_grasp(const vmech_tick* tick, vmech_pose* pose);
/* The wrenches of all joints at the last step, [joints, 6]. `count`: how many joints there is room
 * for. VMECH_INVALID if that is too few. */
VMECH_API vmech_status vmech_tick_wrenches(const vmech_tick* tick, double* wrenches, size_t count);

#ifdef __cplusplus
}
#endif

#ifndef SUPEL_H
#define SUPEL_H

/* Made from src/capi.rs by `SUPEL_WRITE_HEADER=1 cargo test --test capi`. */

#include <stddef.h>
#include <stdint.h>

// Floating frame in which the deformation has no momentum.
#define SUPEL_MASS_WEIGHTED 0

// Floating frame in which the deformation measures of the nodes have no mean.
#define SUPEL_RIGID 1

// Deformation measured by the motion of the nodes relative to the floating frame.
#define SUPEL_MOTION_BASED 0

// Deformation measured by displacements and skew parts of rotations, for comparison.
#define SUPEL_CLASSICAL 1

// What a call says.
typedef enum SupelStatus {
  // Done.
  SUPEL_STATUS_OK = 0,
  // A pointer is null, a value is none of those that have a name, or a workspace belongs to another component.
  SUPEL_STATUS_ARGUMENT = 1,
  // The file cannot be read or is no superelement.
  SUPEL_STATUS_FILE = 2,
  // The superelement cannot undergo large motion.
  SUPEL_STATUS_COMPONENT = 3,
  // The component cannot be evaluated in this state, loaded there, or recovered from this file.
  SUPEL_STATUS_STATE = 4,
  // An error of the library.
  SUPEL_STATUS_INTERNAL = 5,
} SupelStatus;

// A superelement in large motion.
typedef struct SupelComponent SupelComponent;

// Scratch and results of one thread's evaluations of one component.
//
// Pointers to its results are valid until it is freed, and their values change with the next evaluation; pointers that a
// component gives are valid until that is freed. No array that the caller passes to a function may overlap with these.
typedef struct SupelWorkspace SupelWorkspace;

// A rigid-body motion x -> R x + u.
typedef struct SupelMotion {
  // R, row by row.
  double rotation[3][3];
  // u.
  double translation[3];
} SupelMotion;

// State of a component; the arrays remain the caller's.
typedef struct SupelState {
  // Changes of configuration of the interface nodes.
  const struct SupelMotion *motions;
  // Modal amplitudes; may be null if there are none.
  const double *amplitudes;
  // Material velocities: six for each node, then the rates of the amplitudes.
  const double *velocities;
  // Material accelerations.
  const double *accelerations;
} SupelState;

// A force and a moment on an interface node, constant in inertial axes.
typedef struct SupelDeadLoad {
  // Number of the interface node, from 0.
  size_t node;
  // Force.
  double force[3];
  // Moment.
  double moment[3];
} SupelDeadLoad;

// Where a node inside the component has gone.
typedef struct SupelRecoveredNode {
  // Displacement, in inertial axes.
  double displacement[3];
  // Rotation matrix, row by row: that of the floating frame where the file recovers no rotation of the node.
  double rotation[3][3];
} SupelRecoveredNode;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

// Reason of the last failure on this thread; valid until the next one.
const char *supel_last_error(void);

// Reads a superelement file and makes a component of it with motion-based measures, to be freed by
// `supel_component_free`.
//
// # Safety
//
// `path` is a string that ends with a zero byte, `component` points to a pointer.
enum SupelStatus supel_component_open(const char *path, uint32_t frame, struct SupelComponent **component);

// As `supel_component_open`, with a choice of measures: `SUPEL_MOTION_BASED` or `SUPEL_CLASSICAL`.
//
// # Safety
//
// As of `supel_component_open`.
enum SupelStatus supel_component_open_with(const char *path,
                                           uint32_t frame,
                                           uint32_t measures,
                                           struct SupelComponent **component);

// Frees a component; null is allowed.
//
// # Safety
//
// `component` comes from `supel_component_open` and is not used afterwards.
void supel_component_free(struct SupelComponent *component);

// Number of interface nodes; 0 for null.
//
// # Safety
//
// `component` is null or comes from `supel_component_open`.
size_t supel_n_nodes(const struct SupelComponent *component);

// Number of modal amplitudes; 0 for null.
//
// # Safety
//
// `component` is null or comes from `supel_component_open`.
size_t supel_n_modal(const struct SupelComponent *component);

// Number of coordinates: six for each node and one for each amplitude; 0 for null.
//
// # Safety
//
// `component` is null or comes from `supel_component_open`.
size_t supel_n_coordinates(const struct SupelComponent *component);

// Positions of the interface nodes in the reference configuration, three for each; null for null.
//
// # Safety
//
// `component` is null or comes from `supel_component_open`.
const double *supel_positions(const struct SupelComponent *component);

// Stiffness without deformation; null for null.
//
// # Safety
//
// `component` is null or comes from `supel_component_open`.
const double *supel_reference_stiffness(const struct SupelComponent *component);

// Damping without deformation; null for null and where the file has no damping.
//
// # Safety
//
// `component` is null or comes from `supel_component_open`.
const double *supel_reference_damping(const struct SupelComponent *component);

// Mass without deformation; null for null.
//
// # Safety
//
// `component` is null or comes from `supel_component_open`.
const double *supel_reference_mass(const struct SupelComponent *component);

// Room for the evaluations of a component by one thread, to be freed by `supel_workspace_free`.
//
// # Safety
//
// `component` is null or comes from `supel_component_open`; `workspace` is null or points to a pointer.
enum SupelStatus supel_workspace_new(const struct SupelComponent *component, struct SupelWorkspace **workspace);

// Frees a workspace; null is allowed.
//
// # Safety
//
// `workspace` comes from `supel_workspace_new` and is not used afterwards.
void supel_workspace_free(struct SupelWorkspace *workspace);

// Floating frame, deformation, forces and energies of a state.
//
// # Safety
//
// `component` and `workspace` come from this library; `state` points to a state
// whose arrays have as many values as the component has nodes, amplitudes and coordinates. Each may be null.
enum SupelStatus supel_evaluate(const struct SupelComponent *component,
                                const struct SupelState *state,
                                struct SupelWorkspace *workspace);

// Stiffness, mass and gyroscopic matrix of a state.
//
// # Safety
//
// As of `supel_evaluate`.
enum SupelStatus supel_tangents(const struct SupelComponent *component,
                                const struct SupelState *state,
                                struct SupelWorkspace *workspace);

// Adds the forces of gravity, an acceleration in inertial axes, in the state last evaluated in the workspace.
//
// # Safety
//
// `component` and `workspace` as of `supel_evaluate`; `gravity` points to three values, `forces` to as many as the
// component has coordinates. Each may be null.
enum SupelStatus supel_add_gravity(const struct SupelComponent *component,
                                   const double *gravity,
                                   struct SupelWorkspace *workspace,
                                   double *forces);

// Adds a dead load to `forces`.
//
// # Safety
//
// `component` comes from this library, `load` points to a load, `motions` to as many motions as the component has nodes,
// `forces` to as many values as it has coordinates. Each may be null.
enum SupelStatus supel_add_load(const struct SupelComponent *component,
                                const struct SupelDeadLoad *load,
                                const struct SupelMotion *motions,
                                double *forces);

// Adds the load stiffness of a dead load to `stiffness`, a matrix.
//
// # Safety
//
// As of `supel_add_load`, `stiffness` being a matrix.
enum SupelStatus supel_add_load_stiffness(const struct SupelComponent *component,
                                          const struct SupelDeadLoad *load,
                                          const struct SupelMotion *motions,
                                          double *stiffness);

// Change of configuration of the floating frame.
//
// # Safety
//
// `workspace` comes from this library, `frame` points to a motion. Each may be null.
enum SupelStatus supel_floating_frame(const struct SupelWorkspace *workspace, struct SupelMotion *frame);

// Starts the next search for the floating frame from `frame`, which the next evaluation checks.
//
// # Safety
//
// `workspace` comes from this library, `frame` points to a motion. Each may be null.
enum SupelStatus supel_set_floating_frame(struct SupelWorkspace *workspace, const struct SupelMotion *frame);

// Number of nodes that the file recovers; 0 for null.
//
// # Safety
//
// `component` is null or comes from `supel_component_open`.
size_t supel_n_recovered(const struct SupelComponent *component);

// Labels of the recovered nodes, in the order of their displacements; null for null and where there are none.
//
// # Safety
//
// `component` is null or comes from `supel_component_open`.
const int64_t *supel_recovered_labels(const struct SupelComponent *component);

// Displacements and rotations of the recovered nodes in the state last evaluated in the workspace.
//
// The file has no positions of these nodes: `positions` gives three values for each, in the reference configuration. A
// file may hold nodes with only some directions, which cannot be turned with the floating frame: one of them is an error.
//
// # Safety
//
// `component` and `workspace` as of `supel_evaluate`; `positions` points to three values and `nodes` to one node for each
// recovered node. Each may be null.
enum SupelStatus supel_recover(const struct SupelComponent *component,
                               const struct SupelWorkspace *workspace,
                               const double *positions,
                               struct SupelRecoveredNode *nodes);

// Rate of the deformation measure of the state last evaluated; null for null.
//
// # Safety
//
// `workspace` is null or comes from `supel_workspace_new`.
const double *supel_deformation_rate(const struct SupelWorkspace *workspace);

// Material velocity of the floating frame of the state last evaluated, six values; null for null.
//
// # Safety
//
// `workspace` is null or comes from `supel_workspace_new`.
const double *supel_frame_velocity(const struct SupelWorkspace *workspace);

// Damping matrix of the state whose tangents were last asked for; null for null and where the file has no damping.
//
// # Safety
//
// `workspace` is null or comes from `supel_workspace_new`.
const double *supel_damping(const struct SupelWorkspace *workspace);

// The part of the gyroscopic matrix that comes from the momentum of the floating frame, the paper's eq. (87); null for null.
//
// # Safety
//
// `workspace` is null or comes from `supel_workspace_new`.
const double *supel_frame_gyroscopic(const struct SupelWorkspace *workspace);

// Deformation measure of the state last evaluated; null for null.
//
// # Safety
//
// `workspace` is null or comes from `supel_workspace_new`.
const double *supel_deformation(const struct SupelWorkspace *workspace);

// Elastic forces of the state last evaluated; null for null.
//
// # Safety
//
// `workspace` is null or comes from `supel_workspace_new`.
const double *supel_elastic_forces(const struct SupelWorkspace *workspace);

// Inertial forces of the state last evaluated; null for null.
//
// # Safety
//
// `workspace` is null or comes from `supel_workspace_new`.
const double *supel_inertial_forces(const struct SupelWorkspace *workspace);

// Damping forces of the state last evaluated; null for null.
//
// # Safety
//
// `workspace` is null or comes from `supel_workspace_new`.
const double *supel_damping_forces(const struct SupelWorkspace *workspace);

// Tangent stiffness of the state whose tangents were last asked for, a matrix; null for null.
//
// # Safety
//
// `workspace` is null or comes from `supel_workspace_new`.
const double *supel_stiffness(const struct SupelWorkspace *workspace);

// Mass of the state whose tangents were last asked for, a matrix; null for null.
//
// # Safety
//
// `workspace` is null or comes from `supel_workspace_new`.
const double *supel_mass(const struct SupelWorkspace *workspace);

// Gyroscopic matrix of the state whose tangents were last asked for; null for null.
//
// # Safety
//
// `workspace` is null or comes from `supel_workspace_new`.
const double *supel_gyroscopic(const struct SupelWorkspace *workspace);

// Strain energy of the state last evaluated; not a number for null.
//
// # Safety
//
// `workspace` is null or comes from `supel_workspace_new`.
double supel_strain_energy(const struct SupelWorkspace *workspace);

// Kinetic energy of the state last evaluated; not a number for null.
//
// # Safety
//
// `workspace` is null or comes from `supel_workspace_new`.
double supel_kinetic_energy(const struct SupelWorkspace *workspace);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* SUPEL_H */

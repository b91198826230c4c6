#ifndef SUPEL_H
#define SUPEL_H

/* Made from src/capi.rs by `SUPEL_WRITE_HEADER=1 cargo test --test capi`. */

#include <stddef.h>
#include <stdint.h>

/* The modal component of a superelement file: forces and tangent matrices in large motion with small deformation.
 *
 * Deformation is linear in the floating frame of a component. Inside a component there is therefore no stress stiffening, and
 * its inertia is that of the undeformed shape, whatever the tangent: a slender part that turns fast or carries a large load is
 * divided into several components.
 *
 * Coordinates are material: of each interface node the velocity of the material point that was at the inertial origin, in the
 * node's axes; supel_velocities_to_origin, supel_forces_to_nodes and supel_matrix_to_nodes change to those at the node. */

// Floating frame in which the deformation has no momentum.
#define SUPEL_MASS_WEIGHTED 0

// Floating frame in which the deformation measures of the nodes have no mean.
#define SUPEL_RIGID 1

// Deformation measured by the motion of the nodes relative to the floating frame.
#define SUPEL_MOTION_BASED 0

// Deformation measured by displacements and skew parts of rotations, for comparison.
#define SUPEL_CLASSICAL 1

// The mass matrix is semidefinite: it cannot be factored, and an explicit integrator cannot be used. An implicit one needs numerical
// damping, because motions without mass follow at once.
#define SUPEL_SINGULAR_MASS 1

// The stiffness is the tangent of a preloaded state. No component is made of such a file.
#define SUPEL_PRELOADED 2

// A bit of `supel_flags`: the superelement was made for statics alone and has no mass; no component can be made of it.
#define SUPEL_STIFFNESS_ONLY 4

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

// What a check said when the file was made; the later the worse.
typedef enum SupelVerdict {
  // Within its limit.
  SUPEL_VERDICT_PASS = 0,
  // Past its limit, not past the point of failure.
  SUPEL_VERDICT_WARN = 1,
  // Past the point of failure.
  SUPEL_VERDICT_FAIL = 2,
} SupelVerdict;

// A superelement in large motion.
//
// Its deformation is linear in its floating frame: inside a component there is no stress stiffening, whatever the tangent. A
// slender part that turns fast or carries a large load is divided into several components.
typedef struct SupelComponent SupelComponent;

// Scratch and results of one thread's evaluations of one component.
//
// Pointers to its results are valid until it is freed, and their values change with the next evaluation; pointers that a
// component gives are valid until that is freed. No array that the caller passes to a function may overlap with these.
typedef struct SupelWorkspace SupelWorkspace;

// One check of the file's verification.
typedef struct SupelCheck {
  // Its identifier, `M-05`, valid until the component is freed.
  const char *id;
  // The measured value; not a number where none was found.
  double value;
  // The limit it was judged by.
  double limit;
  // What was said.
  enum SupelVerdict verdict;
} SupelCheck;

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

// Version of the library, `1.2.3`.
const char *supel_version(void);

// Reason of the last failure on this thread; valid until the next one.
const char *supel_last_error(void);

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

// Rigid-body mass about the inertial origin, 6 x 6, row by row; null for null.
//
// # Safety
//
// `component` is null or comes from `supel_component_open`.
const double *supel_rigid_mass(const struct SupelComponent *component);

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

// Reads a superelement file and makes a component of it with motion-based measures, to be freed by
// `supel_component_free`.
//
// A file whose verification failed is opened, too: `supel_verdict` tells.
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

// Makes a component of the `n_bytes` bytes of a superelement file in memory, which may be freed afterwards.
//
// # Safety
//
// `bytes` points to `n_bytes` bytes, `component` to a pointer. Each may be null.
enum SupelStatus supel_component_open_bytes(const uint8_t *bytes,
                                            size_t n_bytes,
                                            uint32_t frame,
                                            uint32_t measures,
                                            struct SupelComponent **component);

// Name of an interface node, from 0; null for null and for a node that is not there.
//
// # Safety
//
// `component` is null or comes from `supel_component_open`.
const char *supel_interface_name(const struct SupelComponent *component, size_t node);

// Number of loads that the file carries; zero for null.
//
// # Safety
//
// `component` is null or comes from `supel_component_open`.
size_t supel_n_load_vectors(const struct SupelComponent *component);

// Name of a load of the file, from 0; null for null and for a load that is not there.
//
// # Safety
//
// `component` is null or comes from `supel_component_open`.
const char *supel_load_vector_name(const struct SupelComponent *component, size_t load);

// Label of an interface node in the model; null for null, for a node that is not there and for one that the reduction added.
//
// # Safety
//
// `component` is null or comes from `supel_component_open`.
const int64_t *supel_interface_label(const struct SupelComponent *component,
                                     size_t node);

// Axes of the interface nodes in the reference configuration: for each node a rotation matrix, row by row, whose columns are
// its axes; null for null. Coordinates, forces and matrices do not depend on them.
//
// # Safety
//
// `component` is null or comes from `supel_component_open`.
const double *supel_interface_frames(const struct SupelComponent *component);

// Label of the units of all numbers, `mm-t-s`; null for null and where the file names none.
//
// # Safety
//
// `component` is null or comes from `supel_component_open`.
const char *supel_units(const struct SupelComponent *component);

// Lowest and highest frequency of excitation in Hz for which the file was made; null for null and where it names none.
//
// # Safety
//
// `component` is null or comes from `supel_component_open`.
const double *supel_band_hz(const struct SupelComponent *component);

// Number of sentences on what the file takes for granted about the simulation; 0 for null.
//
// # Safety
//
// `component` is null or comes from `supel_component_open`.
size_t supel_n_assumptions(const struct SupelComponent *component);

// One of these sentences, from 0; null for null and for one that is not there.
//
// # Safety
//
// `component` is null or comes from `supel_component_open`.
const char *supel_assumption(const struct SupelComponent *component, size_t index);

// Properties that a client must know, a sum of `SUPEL_SINGULAR_MASS` and those to come; 0 for null.
//
// # Safety
//
// `component` is null or comes from `supel_component_open`.
uint32_t supel_flags(const struct SupelComponent *component);

// What the verification said when the file was made, no better than the worst of its checks.
//
// It is read from the file and not found anew; `supel verify` does that.
//
// # Safety
//
// `component` is null or comes from `supel_component_open`; `verdict` is null or points to a verdict.
enum SupelStatus supel_verdict(const struct SupelComponent *component, enum SupelVerdict *verdict);

// Number of checks behind the verdict; 0 for null.
//
// # Safety
//
// `component` is null or comes from `supel_component_open`.
size_t supel_n_checks(const struct SupelComponent *component);

// One of these checks, from 0.
//
// # Safety
//
// `component` is null or comes from `supel_component_open`; `check` is null or points to a check.
enum SupelStatus supel_check(const struct SupelComponent *component, size_t index, struct SupelCheck *check);

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

// Stiffness, mass, gyroscopic and damping matrix of a state, as the paper has them.
//
// # Safety
//
// As of `supel_evaluate`.
enum SupelStatus supel_tangents(const struct SupelComponent *component,
                                const struct SupelState *state,
                                struct SupelWorkspace *workspace);

// Forces, tangents and exact stiffness of a state: all derivatives of elastic, inertial and damping forces, by the place
// (`supel_exact_stiffness`), by the velocities (`supel_gyroscopic`, `supel_damping`) and by the accelerations (`supel_mass`).
//
// `supel_stiffness` has no derivative of inertial forces and no geometric part: use this for linear vibration about a fast
// rotation. A component has no stress stiffening inside, neither here nor there.
//
// # Safety
//
// As of `supel_evaluate`.
enum SupelStatus supel_exact_tangents(const struct SupelComponent *component,
                                      const struct SupelState *state,
                                      struct SupelWorkspace *workspace);

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

// Adds the stiffness of gravity, minus the derivative of its forces by the place, to `stiffness`, a matrix, in the state last
// evaluated in the workspace.
//
// # Safety
//
// As of `supel_add_gravity`, `stiffness` being a matrix.
enum SupelStatus supel_add_gravity_stiffness(const struct SupelComponent *component,
                                             const double *gravity,
                                             struct SupelWorkspace *workspace,
                                             double *stiffness);

// Potential energy in a gravity field, an acceleration in inertial axes, in the state last evaluated in the workspace; zero
// with all mass at the inertial origin.
//
// # Safety
//
// `component` and `workspace` as of `supel_evaluate`; `gravity` points to three values, `potential` to one. Each may be null.
enum SupelStatus supel_gravity_potential(const struct SupelComponent *component,
                                         const double *gravity,
                                         const struct SupelWorkspace *workspace,
                                         double *potential);

// Adds the forces of load number `load` of the file, from 0, with an amplitude, in the state last evaluated in the workspace. The
// load turns with the floating frame.
//
// # Safety
//
// `component` and `workspace` as of `supel_evaluate`; `forces` points to as many values as the component has coordinates. Each
// may be null.
enum SupelStatus supel_add_load_vector(const struct SupelComponent *component,
                                       size_t load,
                                       double amplitude,
                                       struct SupelWorkspace *workspace,
                                       double *forces);

// Adds the stiffness of load number `load` of the file, minus the derivative of its forces by the place, to `stiffness`, a matrix,
// in the state last evaluated in the workspace.
//
// # Safety
//
// As of `supel_add_load_vector`, `stiffness` being a matrix.
enum SupelStatus supel_add_load_vector_stiffness(const struct SupelComponent *component,
                                                 size_t load,
                                                 double amplitude,
                                                 struct SupelWorkspace *workspace,
                                                 double *stiffness);

// Turns velocities, accelerations or increments at the nodes, (R^T dx/dt; omega) of each, into those of the component, in
// place.
//
// # Safety
//
// `component` comes from this library, `velocities` points to as many values as it has coordinates. Each may be null.
enum SupelStatus supel_velocities_to_origin(const struct SupelComponent *component,
                                            double *velocities);

// Turns velocities, accelerations or increments of the component into those at the nodes, (R^T dx/dt; omega) of each, in
// place.
//
// # Safety
//
// As of `supel_velocities_to_origin`.
enum SupelStatus supel_velocities_to_nodes(const struct SupelComponent *component,
                                           double *velocities);

// Turns forces of the component into forces and moments at the nodes, in their own axes, in place.
//
// # Safety
//
// As of `supel_velocities_to_origin`, of `forces`.
enum SupelStatus supel_forces_to_nodes(const struct SupelComponent *component, double *forces);

// Turns a matrix of the component into one for coordinates at the nodes, in place.
//
// # Safety
//
// As of `supel_velocities_to_origin`, `matrix` being a matrix.
enum SupelStatus supel_matrix_to_nodes(const struct SupelComponent *component, double *matrix);

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

// Positions of the recovered nodes in the reference configuration, three values for each; null for null and where the file does
// not have them.
//
// # Safety
//
// `component` is null or comes from `supel_component_open`.
const double *supel_recovered_positions(const struct SupelComponent *component);

// Displacements and rotations of the recovered nodes in the state last evaluated in the workspace.
//
// `positions` gives three values for each of these nodes, in the reference configuration: those of `supel_recovered_positions`, or
// the caller's own for a file that does not have them. Nodes of which a file holds only some directions cannot be turned with the
// floating frame; they are none of the recovered nodes.
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

// Tangent stiffness of the state whose tangents were last asked for, a symmetric matrix without the derivative of inertial
// forces by the place; null for null.
//
// # Safety
//
// `workspace` is null or comes from `supel_workspace_new`.
const double *supel_stiffness(const struct SupelWorkspace *workspace);

// Exact stiffness of the state last given to `supel_exact_tangents`, a matrix that is not symmetric; null for null.
//
// # Safety
//
// `workspace` is null or comes from `supel_workspace_new`.
const double *supel_exact_stiffness(const struct SupelWorkspace *workspace);

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

// Momentum of the state last evaluated in the floating frame: linear, then angular about the frame's origin; null for null.
//
// # Safety
//
// `workspace` is null or comes from `supel_workspace_new`.
const double *supel_frame_momentum(const struct SupelWorkspace *workspace);

// Power that the damping takes from the motion in the state last evaluated; not a number for null.
//
// # Safety
//
// `workspace` is null or comes from `supel_workspace_new`.
double supel_dissipated_power(const struct SupelWorkspace *workspace);

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

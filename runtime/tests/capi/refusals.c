/* Wrong calls end in a status and a reason, never in a crash; argv: a damped superelement file of two nodes that recovers a
 * node, and another one with as many coordinates, of one node, that recovers some directions of a node. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "supel.h"

static void expect(int line, SupelStatus found, SupelStatus expected, const char *reason)
{
    if (found != expected || (expected != SUPEL_STATUS_OK && strstr(supel_last_error(), reason) == NULL)) {
        fprintf(stderr, "line %d: status %d, reason: %s\n", line, (int)found, supel_last_error());
        exit(1);
    }
}

#define EXPECT(call, status, reason) expect(__LINE__, call, status, reason)
#define REQUIRE(truth) expect(__LINE__, (truth) ? SUPEL_STATUS_OK : SUPEL_STATUS_INTERNAL, SUPEL_STATUS_OK, "")

int main(int argc, char **argv)
{
    SupelComponent *component = NULL, *other = NULL;
    SupelWorkspace *workspace = NULL, *foreign = NULL;
    REQUIRE(argc == 3);

    EXPECT(supel_component_open(NULL, SUPEL_RIGID, &component), SUPEL_STATUS_ARGUMENT, "path is null");
    EXPECT(supel_component_open(argv[1], SUPEL_RIGID, NULL), SUPEL_STATUS_ARGUMENT, "component is null");
    EXPECT(supel_component_open(argv[1], 7, &component), SUPEL_STATUS_ARGUMENT, "floating frame 7, expected 0");
    EXPECT(supel_component_open_with(argv[1], SUPEL_RIGID, 2, &component), SUPEL_STATUS_ARGUMENT, "measures 2, expected 0");
    EXPECT(supel_component_open("no.supel", SUPEL_RIGID, &component), SUPEL_STATUS_FILE, "no.supel");
    EXPECT(supel_component_open("\xff", SUPEL_RIGID, &component), SUPEL_STATUS_FILE, "path is not UTF-8");
    unsigned char bytes[3] = {1, 2, 3};
    EXPECT(supel_component_open_bytes(NULL, 3, SUPEL_RIGID, SUPEL_CLASSICAL, &component), SUPEL_STATUS_ARGUMENT, "bytes is null");
    EXPECT(supel_component_open_bytes(bytes, 3, SUPEL_RIGID, SUPEL_CLASSICAL, NULL), SUPEL_STATUS_ARGUMENT, "component is null");
    EXPECT(supel_component_open_bytes(bytes, 3, 2, SUPEL_CLASSICAL, &component), SUPEL_STATUS_ARGUMENT, "floating frame 2");
    EXPECT(supel_component_open_bytes(bytes, 3, SUPEL_RIGID, 2, &component), SUPEL_STATUS_ARGUMENT, "measures 2");
    EXPECT(supel_component_open_bytes(bytes, SIZE_MAX, SUPEL_RIGID, 0, &component), SUPEL_STATUS_ARGUMENT, "more than memory");
    EXPECT(supel_component_open_bytes(bytes, 3, SUPEL_RIGID, SUPEL_CLASSICAL, &component), SUPEL_STATUS_FILE, "3 bytes");
    EXPECT(supel_component_open_bytes(NULL, 0, SUPEL_RIGID, SUPEL_CLASSICAL, &component), SUPEL_STATUS_FILE, "0 bytes");
    REQUIRE(component == NULL);
    SupelVerdict verdict;
    SupelCheck check;
    EXPECT(supel_verdict(NULL, &verdict), SUPEL_STATUS_ARGUMENT, "component is null");
    EXPECT(supel_check(NULL, 0, &check), SUPEL_STATUS_ARGUMENT, "component is null");
    REQUIRE(supel_interface_name(NULL, 0) == NULL && supel_interface_label(NULL, 0) == NULL);
    REQUIRE(supel_interface_frames(NULL) == NULL && supel_units(NULL) == NULL && supel_band_hz(NULL) == NULL);
    REQUIRE(supel_n_assumptions(NULL) == 0 && supel_assumption(NULL, 0) == NULL && supel_flags(NULL) == 0);
    REQUIRE(supel_n_checks(NULL) == 0 && supel_rigid_mass(NULL) == NULL && supel_exact_stiffness(NULL) == NULL);
    REQUIRE(supel_frame_momentum(NULL) == NULL && isnan(supel_dissipated_power(NULL)));
    EXPECT(supel_component_open(argv[1], SUPEL_RIGID, &component), SUPEL_STATUS_OK, "");
    EXPECT(supel_workspace_new(NULL, &workspace), SUPEL_STATUS_ARGUMENT, "component is null");
    EXPECT(supel_workspace_new(component, NULL), SUPEL_STATUS_ARGUMENT, "workspace is null");
    EXPECT(supel_workspace_new(component, &workspace), SUPEL_STATUS_OK, "");

    EXPECT(supel_verdict(component, NULL), SUPEL_STATUS_ARGUMENT, "verdict is null");
    EXPECT(supel_check(component, 0, NULL), SUPEL_STATUS_ARGUMENT, "check is null");
    EXPECT(supel_check(component, 2, &check), SUPEL_STATUS_ARGUMENT, "check 2 (from 0), the file has 2");
    REQUIRE(supel_interface_name(component, 2) == NULL && supel_interface_label(component, 2) == NULL);
    REQUIRE(supel_assumption(component, 1) == NULL);
    size_t nodes = supel_n_nodes(component), n = supel_n_coordinates(component);
    REQUIRE(nodes == 2 && n == 12 + supel_n_modal(component));
    SupelMotion identity = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {0, 0, 0}}, frame;
    SupelMotion motions[2] = {identity, identity};
    double *zeros = calloc(n, sizeof *zeros), *forces = calloc(n * n, sizeof *forces);
    double gravity[3] = {0, 0, 1};
    REQUIRE(zeros != NULL && forces != NULL);
    SupelState state = {motions, zeros, zeros, zeros}, missing = {motions, zeros, NULL, zeros};
    SupelDeadLoad load = {2, {0, 0, 0}, {0, 0, 0}};

    EXPECT(supel_evaluate(NULL, &state, workspace), SUPEL_STATUS_ARGUMENT, "component is null");
    EXPECT(supel_evaluate(component, NULL, workspace), SUPEL_STATUS_ARGUMENT, "state is null");
    EXPECT(supel_evaluate(component, &state, NULL), SUPEL_STATUS_ARGUMENT, "workspace is null");
    EXPECT(supel_evaluate(component, &missing, workspace), SUPEL_STATUS_ARGUMENT, "state.velocities is null");
    EXPECT(supel_tangents(component, &missing, workspace), SUPEL_STATUS_ARGUMENT, "state.velocities is null");
    EXPECT(supel_tangents(component, &state, workspace), SUPEL_STATUS_OK, "");
    double potential = 0.0, nowhere[3] = {0, NAN, 0};
    EXPECT(supel_exact_tangents(NULL, &state, workspace), SUPEL_STATUS_ARGUMENT, "component is null");
    EXPECT(supel_exact_tangents(component, &missing, workspace), SUPEL_STATUS_ARGUMENT, "state.velocities is null");
    EXPECT(supel_add_gravity(component, nowhere, workspace, forces), SUPEL_STATUS_STATE, "entry 1 (from 0) of the acceleration");
    EXPECT(supel_add_gravity(NULL, gravity, workspace, forces), SUPEL_STATUS_ARGUMENT, "component is null");
    EXPECT(supel_add_gravity(component, gravity, NULL, forces), SUPEL_STATUS_ARGUMENT, "workspace is null");
    EXPECT(supel_add_gravity_stiffness(component, nowhere, workspace, forces), SUPEL_STATUS_STATE, "entry 1 (from 0)");
    EXPECT(supel_add_gravity_stiffness(component, gravity, workspace, NULL), SUPEL_STATUS_ARGUMENT, "stiffness is null");
    EXPECT(supel_add_load_vector(component, 1, 1.0, workspace, forces), SUPEL_STATUS_STATE, "it carries 1");
    EXPECT(supel_add_load_vector(NULL, 0, 1.0, workspace, forces), SUPEL_STATUS_ARGUMENT, "component is null");
    EXPECT(supel_add_load_vector(component, 0, 1.0, NULL, forces), SUPEL_STATUS_ARGUMENT, "workspace is null");
    EXPECT(supel_add_load_vector(component, 0, 1.0, workspace, NULL), SUPEL_STATUS_ARGUMENT, "forces is null");
    EXPECT(supel_add_load_vector_stiffness(component, 1, 1.0, workspace, forces), SUPEL_STATUS_STATE, "load 1 (from 0)");
    EXPECT(supel_add_load_vector_stiffness(component, 0, 1.0, workspace, NULL), SUPEL_STATUS_ARGUMENT, "stiffness is null");
    EXPECT(supel_gravity_potential(component, nowhere, workspace, &potential), SUPEL_STATUS_STATE, "entry 1 (from 0)");
    EXPECT(supel_gravity_potential(component, gravity, workspace, NULL), SUPEL_STATUS_ARGUMENT, "potential is null");
    EXPECT(supel_gravity_potential(component, gravity, NULL, &potential), SUPEL_STATUS_ARGUMENT, "workspace is null");
    EXPECT(supel_velocities_to_origin(NULL, forces), SUPEL_STATUS_ARGUMENT, "component is null");
    EXPECT(supel_velocities_to_origin(component, NULL), SUPEL_STATUS_ARGUMENT, "velocities is null");
    EXPECT(supel_velocities_to_nodes(component, NULL), SUPEL_STATUS_ARGUMENT, "velocities is null");
    EXPECT(supel_forces_to_nodes(component, NULL), SUPEL_STATUS_ARGUMENT, "forces is null");
    EXPECT(supel_matrix_to_nodes(component, NULL), SUPEL_STATUS_ARGUMENT, "matrix is null");
    EXPECT(supel_add_gravity(component, NULL, workspace, forces), SUPEL_STATUS_ARGUMENT, "gravity is null");
    EXPECT(supel_add_gravity(component, gravity, workspace, NULL), SUPEL_STATUS_ARGUMENT, "forces is null");
    EXPECT(supel_add_load(component, NULL, motions, forces), SUPEL_STATUS_ARGUMENT, "load is null");
    EXPECT(supel_add_load(component, &load, NULL, forces), SUPEL_STATUS_ARGUMENT, "motions is null");
    EXPECT(supel_add_load(component, &load, motions, NULL), SUPEL_STATUS_ARGUMENT, "forces is null");
    EXPECT(supel_add_load(component, &load, motions, forces), SUPEL_STATUS_STATE, "interface node 2");
    EXPECT(supel_add_load_stiffness(component, &load, motions, forces), SUPEL_STATUS_STATE, "interface node 2");
    EXPECT(supel_floating_frame(NULL, &frame), SUPEL_STATUS_ARGUMENT, "workspace is null");
    EXPECT(supel_floating_frame(workspace, NULL), SUPEL_STATUS_ARGUMENT, "frame is null");
    EXPECT(supel_floating_frame(workspace, &frame), SUPEL_STATUS_OK, "");
    REQUIRE(frame.rotation[0][0] == 1.0 && frame.translation[2] == 0.0);
    EXPECT(supel_set_floating_frame(workspace, NULL), SUPEL_STATUS_ARGUMENT, "frame is null");
    EXPECT(supel_set_floating_frame(workspace, &frame), SUPEL_STATUS_OK, "");

    frame.rotation[0][0] = 1.1;
    EXPECT(supel_set_floating_frame(workspace, &frame), SUPEL_STATUS_OK, "");
    EXPECT(supel_evaluate(component, &state, workspace), SUPEL_STATUS_STATE, "floating frame to start from");

    EXPECT(supel_component_open_with(argv[2], SUPEL_RIGID, SUPEL_CLASSICAL, &other), SUPEL_STATUS_OK, "");
    EXPECT(supel_workspace_new(other, &foreign), SUPEL_STATUS_OK, "");
    REQUIRE(supel_n_coordinates(other) == n && supel_n_nodes(other) == 1);
    EXPECT(supel_evaluate(component, &state, foreign), SUPEL_STATUS_ARGUMENT, "another component");
    EXPECT(supel_tangents(component, &state, foreign), SUPEL_STATUS_ARGUMENT, "another component");
    EXPECT(supel_exact_tangents(component, &state, foreign), SUPEL_STATUS_ARGUMENT, "another component");
    EXPECT(supel_add_gravity_stiffness(component, gravity, foreign, forces), SUPEL_STATUS_ARGUMENT, "another component");
    EXPECT(supel_gravity_potential(component, gravity, foreign, &potential), SUPEL_STATUS_ARGUMENT, "another component");

    /* The same file opened twice: a second component, whose workspaces are its own. */
    SupelComponent *twin = NULL;
    SupelWorkspace *of_twin = NULL;
    EXPECT(supel_component_open(argv[1], SUPEL_RIGID, &twin), SUPEL_STATUS_OK, "");
    EXPECT(supel_workspace_new(twin, &of_twin), SUPEL_STATUS_OK, "");
    REQUIRE(supel_n_coordinates(twin) == n && supel_n_nodes(twin) == nodes);
    EXPECT(supel_evaluate(component, &state, of_twin), SUPEL_STATUS_ARGUMENT, "another component");
    EXPECT(supel_evaluate(twin, &state, of_twin), SUPEL_STATUS_OK, "");
    EXPECT(supel_add_gravity(component, gravity, of_twin, forces), SUPEL_STATUS_ARGUMENT, "another component");
    supel_workspace_free(of_twin);
    supel_component_free(twin);
    EXPECT(supel_add_gravity(component, gravity, foreign, forces), SUPEL_STATUS_ARGUMENT, "another component");

    double position[3] = {0, 0, 0};
    SupelRecoveredNode node;
    EXPECT(supel_recover(component, foreign, position, &node), SUPEL_STATUS_ARGUMENT, "another component");
    EXPECT(supel_recover(NULL, workspace, position, &node), SUPEL_STATUS_ARGUMENT, "component is null");
    EXPECT(supel_recover(component, NULL, position, &node), SUPEL_STATUS_ARGUMENT, "workspace is null");
    EXPECT(supel_recover(component, workspace, NULL, &node), SUPEL_STATUS_ARGUMENT, "positions is null");
    EXPECT(supel_recover(component, workspace, position, NULL), SUPEL_STATUS_ARGUMENT, "nodes is null");
    REQUIRE(supel_n_recovered(other) == 0 && supel_recovered_labels(other) == NULL);
    REQUIRE(supel_recovered_positions(component)[1] == 2.5 && supel_recovered_positions(component)[2] == -3.5);
    REQUIRE(supel_recovered_positions(other) == NULL && supel_recovered_positions(NULL) == NULL);
    REQUIRE(supel_n_recovered(component) == 1 && supel_recovered_labels(component)[0] == 4);
    REQUIRE(supel_n_recovered(NULL) == 0 && supel_recovered_labels(NULL) == NULL);

    /* At 2 along z, moving at 3 along x. */
    double *velocities = calloc(n, sizeof *velocities);
    REQUIRE(velocities != NULL);
    velocities[0] = velocities[6] = 3.0;
    motions[0].translation[2] = motions[1].translation[2] = 2.0;
    SupelState moving = {motions, zeros, velocities, zeros};
    EXPECT(supel_tangents(component, &moving, workspace), SUPEL_STATUS_OK, "");
    EXPECT(supel_recover(component, workspace, position, &node), SUPEL_STATUS_OK, "");
    REQUIRE(fabs(node.displacement[2] - 2.0) <= 1e-12 && fabs(node.rotation[1][1] - 1.0) <= 1e-12);
    REQUIRE(fabs(supel_frame_velocity(workspace)[0] - 3.0) <= 1e-12);
    REQUIRE(fabs(supel_deformation_rate(workspace)[0]) <= 1e-12);
    for (size_t i = 0; i < n * n; ++i) {
        REQUIRE(fabs(supel_damping(workspace)[i] - supel_reference_damping(component)[i]) <= 1e-9);
        REQUIRE(isfinite(supel_frame_gyroscopic(workspace)[i]));
    }
    REQUIRE(supel_damping(foreign) == NULL && supel_reference_damping(other) == NULL);
    motions[0] = motions[1] = identity;
    EXPECT(supel_tangents(component, &state, workspace), SUPEL_STATUS_OK, "");
    free(velocities);

    for (size_t i = 0; i < n * n; ++i) {
        REQUIRE(fabs(supel_mass(workspace)[i] - supel_reference_mass(component)[i]) <= 1e-9);
        REQUIRE(fabs(supel_stiffness(workspace)[i] - supel_reference_stiffness(component)[i]) <= 1e-6);
        REQUIRE(supel_gyroscopic(workspace)[i] == 0.0);
    }
    REQUIRE(supel_damping_forces(workspace)[n - 1] == 0.0 && supel_deformation(workspace)[0] == 0.0);
    REQUIRE(supel_strain_energy(workspace) == 0.0 && supel_positions(component)[0] == 1.0);

    motions[1].rotation[0][0] = 0.5;
    EXPECT(supel_evaluate(component, &state, workspace), SUPEL_STATUS_STATE, "not a rotation matrix");
    EXPECT(supel_add_gravity(component, gravity, workspace, forces), SUPEL_STATUS_STATE, "holds no state");
    EXPECT(supel_gravity_potential(component, gravity, workspace, &potential), SUPEL_STATUS_STATE, "holds no state");
    EXPECT(supel_recover(component, workspace, position, &node), SUPEL_STATUS_STATE, "holds no state");
    REQUIRE(supel_n_nodes(NULL) == 0 && supel_positions(NULL) == NULL && supel_mass(NULL) == NULL);
    REQUIRE(isnan(supel_kinetic_energy(NULL)));

    free(forces);
    free(zeros);
    supel_workspace_free(workspace);
    supel_workspace_free(foreign);
    supel_component_free(other);
    supel_workspace_free(NULL);
    supel_component_free(component);
    supel_component_free(NULL);
    return 0;
}

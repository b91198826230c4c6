/* Wrong calls end in a status and a reason, never in a crash; argv: a superelement file. */
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
    SupelComponent *component = NULL;
    SupelWorkspace *workspace = NULL;
    REQUIRE(argc == 2);

    EXPECT(supel_component_open(NULL, SUPEL_RIGID, &component), SUPEL_STATUS_ARGUMENT, "path is null");
    EXPECT(supel_component_open(argv[1], SUPEL_RIGID, NULL), SUPEL_STATUS_ARGUMENT, "component is null");
    EXPECT(supel_component_open(argv[1], 7, &component), SUPEL_STATUS_ARGUMENT, "7 is no floating frame");
    EXPECT(supel_component_open("no.supel", SUPEL_RIGID, &component), SUPEL_STATUS_FILE, "no.supel");
    EXPECT(supel_component_open("\xff", SUPEL_RIGID, &component), SUPEL_STATUS_FILE, "utf-8");
    REQUIRE(component == NULL);
    EXPECT(supel_component_open(argv[1], SUPEL_RIGID, &component), SUPEL_STATUS_OK, "");
    EXPECT(supel_workspace_new(NULL, &workspace), SUPEL_STATUS_ARGUMENT, "component is null");
    EXPECT(supel_workspace_new(component, NULL), SUPEL_STATUS_ARGUMENT, "workspace is null");
    EXPECT(supel_workspace_new(component, &workspace), SUPEL_STATUS_OK, "");

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
    EXPECT(supel_add_gravity(component, NULL, workspace, forces), SUPEL_STATUS_ARGUMENT, "gravity is null");
    EXPECT(supel_add_gravity(component, gravity, workspace, NULL), SUPEL_STATUS_ARGUMENT, "forces is null");
    EXPECT(supel_add_load(component, NULL, motions, forces), SUPEL_STATUS_ARGUMENT, "load is null");
    EXPECT(supel_add_load(component, &load, NULL, forces), SUPEL_STATUS_ARGUMENT, "motions is null");
    EXPECT(supel_add_load(component, &load, motions, NULL), SUPEL_STATUS_ARGUMENT, "result is null");
    EXPECT(supel_add_load(component, &load, motions, forces), SUPEL_STATUS_STATE, "interface node 2");
    EXPECT(supel_add_load_stiffness(component, &load, motions, forces), SUPEL_STATUS_STATE, "interface node 2");
    EXPECT(supel_floating_frame(NULL, &frame), SUPEL_STATUS_ARGUMENT, "workspace is null");
    EXPECT(supel_floating_frame(workspace, NULL), SUPEL_STATUS_ARGUMENT, "frame is null");
    EXPECT(supel_floating_frame(workspace, &frame), SUPEL_STATUS_OK, "");
    REQUIRE(frame.rotation[0][0] == 1.0 && frame.translation[2] == 0.0);
    EXPECT(supel_set_floating_frame(workspace, NULL), SUPEL_STATUS_ARGUMENT, "frame is null");
    EXPECT(supel_set_floating_frame(workspace, &frame), SUPEL_STATUS_OK, "");

    for (size_t i = 0; i < n * n; ++i) {
        REQUIRE(fabs(supel_mass(workspace)[i] - supel_reference_mass(component)[i]) <= 1e-9);
        REQUIRE(fabs(supel_stiffness(workspace)[i] - supel_reference_stiffness(component)[i]) <= 1e-6);
        REQUIRE(supel_gyroscopic(workspace)[i] == 0.0);
    }
    REQUIRE(supel_damping_forces(workspace)[n - 1] == 0.0 && supel_deformation(workspace)[0] == 0.0);
    REQUIRE(supel_strain_energy(workspace) == 0.0 && supel_positions(component)[0] == 1.0);

    motions[1].rotation[0][0] = 0.5;
    EXPECT(supel_evaluate(component, &state, workspace), SUPEL_STATUS_STATE, "not a rotation matrix");
    REQUIRE(supel_n_nodes(NULL) == 0 && supel_positions(NULL) == NULL && supel_mass(NULL) == NULL);
    REQUIRE(isnan(supel_kinetic_energy(NULL)));

    free(forces);
    free(zeros);
    supel_workspace_free(workspace);
    supel_workspace_free(NULL);
    supel_component_free(component);
    supel_component_free(NULL);
    return 0;
}

/* What the calls give; argv: a damped superelement file of two nodes that recovers a node, with
 * a name, a label, a turned frame and a failed verification, and another one of which nothing is said. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "supel.h"

static void require(int line, int truth)
{
    if (!truth) {
        fprintf(stderr, "line %d: last reason: %s\n", line, supel_last_error());
        exit(1);
    }
}

#define REQUIRE(truth) require(__LINE__, truth)
#define OK(call) require(__LINE__, (call) == SUPEL_STATUS_OK)

/* The bytes of a file. */
static unsigned char *contents(const char *path, size_t *n)
{
    FILE *file = fopen(path, "rb");
    REQUIRE(file != NULL && fseek(file, 0, SEEK_END) == 0);
    *n = (size_t)ftell(file);
    unsigned char *bytes = malloc(*n);
    REQUIRE(bytes != NULL && fseek(file, 0, SEEK_SET) == 0 && fread(bytes, 1, *n, file) == *n);
    fclose(file);
    return bytes;
}

/* What the file says besides its matrices. */
static void said(const SupelComponent *component, const SupelComponent *other)
{
    SupelVerdict verdict;
    SupelCheck check;
    int major, minor, patch;
    REQUIRE(sscanf(supel_version(), "%d.%d.%d", &major, &minor, &patch) == 3);
    /* A zero byte inside a name would end it. */
    REQUIRE(strcmp(supel_interface_name(component, 0), "hub   \xc3\xa0 gauche") == 0);
    REQUIRE(strcmp(supel_interface_name(component, 1), "node 1") == 0);
    REQUIRE(supel_n_load_vectors(component) == 1 && supel_n_load_vectors(other) == 0 && supel_n_load_vectors(NULL) == 0);
    REQUIRE(strcmp(supel_load_vector_name(component, 0), "thrust") == 0 && supel_load_vector_name(component, 1) == NULL);
    REQUIRE(*supel_interface_label(component, 0) == 7 && supel_interface_label(component, 1) == NULL);
    const double *frames = supel_interface_frames(component);
    REQUIRE(frames[0] == 1.0 && frames[1] == 0.0 && frames[9] == 0.0 && frames[10] == -1.0 && frames[12] == 1.0);
    REQUIRE(strcmp(supel_units(component), "m-kg-s") == 0 && supel_units(other) == NULL);
    REQUIRE(supel_band_hz(component)[1] == 250.0 && supel_band_hz(other) == NULL);
    REQUIRE(supel_n_assumptions(component) == 1 && strcmp(supel_assumption(component, 0), "nobody pulls") == 0);
    REQUIRE(supel_flags(component) == SUPEL_SINGULAR_MASS && supel_flags(other) == 0);
    OK(supel_verdict(component, &verdict));
    REQUIRE(verdict == SUPEL_VERDICT_FAIL && supel_n_checks(component) == 2);
    OK(supel_check(component, 0, &check));
    REQUIRE(strcmp(check.id, "M-01") == 0 && check.value == 0.25 && check.limit == 0.5);
    REQUIRE(check.verdict == SUPEL_VERDICT_PASS);
    OK(supel_check(component, 1, &check));
    REQUIRE(strcmp(check.id, "M-05") == 0 && isnan(check.value) && check.verdict == SUPEL_VERDICT_FAIL);
    OK(supel_verdict(other, &verdict));
    REQUIRE(verdict == SUPEL_VERDICT_PASS && supel_n_checks(other) == 0);
}

/* The exact stiffness predicts a small step of all forces; coordinates at the nodes keep the power. */
static void derivatives(const SupelComponent *component, SupelWorkspace *workspace)
{
    size_t n = supel_n_coordinates(component);
    double step = 1e-6, *rest = calloc(n, sizeof *rest), *velocities = calloc(n, sizeof *velocities);
    double *before = calloc(n, sizeof *before), *slope = calloc(n, sizeof *slope), gravity[3] = {0, 0, -9.81};
    double *weight = calloc(n, sizeof *weight), *matrix = calloc(n * n, sizeof *matrix), potential, moved;
    REQUIRE(rest && velocities && before && slope && weight && matrix);
    SupelMotion identity = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {0, 0, 0}}, motions[2] = {identity, identity};
    SupelState state = {motions, rest, velocities, rest};
    velocities[5] = velocities[11] = 4.0;
    velocities[0] = velocities[6] = 1.0;
    OK(supel_exact_tangents(component, &state, workspace));
    OK(supel_add_gravity(component, gravity, workspace, weight));
    OK(supel_add_gravity_stiffness(component, gravity, workspace, matrix));
    OK(supel_gravity_potential(component, gravity, workspace, &potential));
    double power = 0.0, steps_work = -step * weight[8];
    OK(supel_add_load_vector(component, 0, 2.0, workspace, weight));
    OK(supel_add_load_vector_stiffness(component, 0, 2.0, workspace, matrix));
    for (size_t i = 0; i < n; ++i) {
        before[i] = supel_elastic_forces(workspace)[i] + supel_inertial_forces(workspace)[i]
            + supel_damping_forces(workspace)[i] - weight[i];
        slope[i] = supel_exact_stiffness(workspace)[i * n + 8] + matrix[i * n + 8];
        power += supel_damping_forces(workspace)[i] * velocities[i];
        weight[i] = 0.0;
    }
    REQUIRE(fabs(power - supel_dissipated_power(workspace)) <= 1e-12 * power && power > 0.0);
    /* Without deformation the momentum is that of the rigid body: 1 along x, and 4 about z. */
    const double *mass = supel_rigid_mass(component);
    REQUIRE(fabs(mass[0] + 4.0 * mass[5] - supel_frame_momentum(workspace)[0]) <= 1e-9 * mass[0]);
    REQUIRE(fabs(mass[0] - mass[7]) <= 1e-9 * mass[0]);

    motions[1].translation[2] = step;
    OK(supel_evaluate(component, &state, workspace));
    OK(supel_add_gravity(component, gravity, workspace, weight));
    OK(supel_add_load_vector(component, 0, 2.0, workspace, weight));
    OK(supel_gravity_potential(component, gravity, workspace, &moved));
    /* A step of 1e-6 leaves its share of the second derivatives, and 1e-16 of forces of order 1e4 over it. */
    for (size_t i = 0; i < n; ++i) {
        double now = supel_elastic_forces(workspace)[i] + supel_inertial_forces(workspace)[i]
            + supel_damping_forces(workspace)[i] - weight[i];
        REQUIRE(fabs((now - before[i]) / step - slope[i]) <= 1.0 + 1e-4 * fabs(slope[i]));
    }
    REQUIRE(fabs(moved - potential - steps_work) <= 1e-3 * fabs(steps_work));

    double work = 0.0, work_at_nodes = 0.0;
    double *at_nodes = calloc(n, sizeof *at_nodes), *forces = calloc(n, sizeof *forces);
    REQUIRE(at_nodes != NULL && forces != NULL);
    for (size_t i = 0; i < n; ++i) {
        forces[i] = 1.0 + (double)i;
        at_nodes[i] = velocities[i];
        work += forces[i] * velocities[i];
    }
    OK(supel_velocities_to_nodes(component, at_nodes));
    OK(supel_forces_to_nodes(component, forces));
    for (size_t i = 0; i < n; ++i) {
        work_at_nodes += forces[i] * at_nodes[i];
    }
    REQUIRE(fabs(work - work_at_nodes) <= 1e-12 * fabs(work));
    OK(supel_velocities_to_origin(component, at_nodes));
    REQUIRE(fabs(at_nodes[1] - velocities[1]) <= 1e-15);
    for (size_t i = 0; i < n * n; ++i) {
        matrix[i] = supel_reference_mass(component)[i];
    }
    OK(supel_matrix_to_nodes(component, matrix));
    /* Turning a node about itself moves less mass than turning it about the origin. */
    REQUIRE(matrix[11 * n + 11] < supel_reference_mass(component)[11 * n + 11]);
    REQUIRE(matrix[6 * n + 6] == supel_reference_mass(component)[6 * n + 6]);
    free(forces);
    free(at_nodes);
    free(matrix);
    free(weight);
    free(slope);
    free(before);
    free(velocities);
    free(rest);
}

int main(int argc, char **argv)
{
    SupelComponent *component = NULL, *from_bytes = NULL, *other = NULL;
    SupelWorkspace *workspace = NULL;
    size_t n_bytes;
    REQUIRE(argc == 3);
    unsigned char *bytes = contents(argv[1], &n_bytes);
    OK(supel_component_open(argv[1], SUPEL_MASS_WEIGHTED, &component));
    OK(supel_component_open(argv[2], SUPEL_MASS_WEIGHTED, &other));
    OK(supel_component_open_bytes(bytes, n_bytes, SUPEL_MASS_WEIGHTED, SUPEL_MOTION_BASED, &from_bytes));
    free(bytes);
    said(component, other);
    said(from_bytes, other);
    size_t n = supel_n_coordinates(component);
    REQUIRE(memcmp(supel_reference_mass(component), supel_reference_mass(from_bytes), n * n * sizeof(double)) == 0);
    OK(supel_workspace_new(component, &workspace));
    derivatives(component, workspace);
    supel_workspace_free(workspace);
    supel_component_free(other);
    supel_component_free(from_bytes);
    supel_component_free(component);
    return 0;
}

/* Forces on a component that spins about the z axis, under its weight and a load on its last node.
 *
 *   cargo rustc -p supel-runtime --release --features capi --crate-type staticlib
 *   cc -Iruntime/capi runtime/capi/example.c target/release/libsupel_runtime.a -lpthread -ldl -lm -o example
 *   ./example bracket.supel
 */
#include <stdio.h>
#include <stdlib.h>

#include "supel.h"

static void require(SupelStatus status)
{
    if (status != SUPEL_STATUS_OK) {
        fprintf(stderr, "supel: %s\n", supel_last_error());
        exit(1);
    }
}

static double *zeros(size_t n)
{
    double *values = calloc(n > 0 ? n : 1, sizeof *values);
    if (values == NULL) {
        exit(1);
    }
    return values;
}

int main(int argc, char **argv)
{
    SupelComponent *component = NULL;
    SupelWorkspace *workspace = NULL;
    if (argc != 2) {
        fprintf(stderr, "usage: example FILE.supel\n");
        return 2;
    }
    require(supel_component_open(argv[1], SUPEL_MASS_WEIGHTED, &component));
    require(supel_workspace_new(component, &workspace));
    SupelVerdict verdict;
    require(supel_verdict(component, &verdict));
    if (verdict == SUPEL_VERDICT_FAIL) {
        fprintf(stderr, "%s: its verification failed; `supel inspect` says where\n", argv[1]);
    }

    size_t nodes = supel_n_nodes(component), n = supel_n_coordinates(component);
    SupelMotion identity = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {0, 0, 0}};
    SupelMotion *motions = malloc(nodes * sizeof *motions);
    double *amplitudes = zeros(supel_n_modal(component)), *velocities = zeros(n), *accelerations = zeros(n);
    double *external = zeros(n);
    if (motions == NULL) {
        return 1;
    }
    for (size_t node = 0; node < nodes; ++node) {
        motions[node] = identity;
        velocities[6 * node + 5] = 10.0;
    }

    SupelState state = {motions, amplitudes, velocities, accelerations};
    SupelDeadLoad load = {nodes - 1, {0, 100, 0}, {0, 0, 0}};
    double gravity[3] = {0, 0, -9.81};
    require(supel_evaluate(component, &state, workspace));
    require(supel_add_gravity(component, gravity, workspace, external));
    require(supel_add_load(component, &load, motions, external));

    const double *elastic = supel_elastic_forces(workspace), *inertial = supel_inertial_forces(workspace);
    printf("kinetic energy %.17g\n", supel_kinetic_energy(workspace));
    for (size_t i = 0; i < n; ++i) {
        printf("%.17g %.17g %.17g\n", elastic[i], inertial[i], external[i]);
    }

    free(external);
    free(accelerations);
    free(velocities);
    free(amplitudes);
    free(motions);
    supel_workspace_free(workspace);
    supel_component_free(component);
    return 0;
}

/* test_mpi_network.c: two machines, here two network namespaces with a cable between them, share a render: the bits of
 * one process, and the cable's counters show that the film went through it.  Skipped where the test may not make
 * namespaces, and where facet was built without MPI.
 * SPDX-License-Identifier: MIT */
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
/* cmocka needs the headers above */
#include <cmocka.h>

#include "render/film.h"
#include "tests/picture_bytes.h"
#include "tests/program_folder.h"

/* Each machine has a network and a host name of its own.  On one kernel, UCX would otherwise find memory that both
 * see; inside a container, Open MPI would look for other interfaces. */
static const char environment[] =
    "export A=facet-$PPID-a B=facet-$PPID-b\n"
    "export UCX_TLS=tcp,self UCX_NET_DEVICES=eth0 UCX_WARN_UNUSED_ENV_VARS=n\n"
    "export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_mpi_yield_when_idle=1\n"
    "export OMPI_MCA_btl=tcp,self OMPI_MCA_pml=ob1 OMPI_MCA_btl_tcp_if_include=eth0 OMPI_MCA_oob_tcp_if_include=eth0\n"
    "export OMPI_MCA_plm_rsh_agent=$PWD/remote_shell\n";

static const char make_machines[] =
    ". ./environment\n"
    "set -e\n"
    "ip netns add $A; ip netns add $B\n"
    "ip link add eth0 netns $A type veth peer name eth0 netns $B\n"
    "ip -n $A address add 10.77.0.1/24 dev eth0; ip -n $B address add 10.77.0.2/24 dev eth0\n"
    "for machine in $A $B; do ip -n $machine link set lo up; ip -n $machine link set eth0 up; done\n"
    "for machine in $A $B; do\n"
    "    while ! ip -n $machine link show eth0 | grep -q 'state UP'; do sleep .01; done\n"
    "done\n"
    "ip netns exec $A unshare --uts true\n";

/* Stands in for ssh: [OPTION]... HOST COMMAND... */
static const char remote_shell[] = "#!/bin/sh\n"
                                   "while case $1 in -*) true;; *) false;; esac; do shift; done\n"
                                   "case $1 in 10.77.0.1) machine=$A;; *) machine=$B;; esac\n"
                                   "shift\n"
                                   "exec ip netns exec $machine unshare --uts sh -c \"hostname $machine; $*\"\n";

static program_run shell(const char *line)
{
    return run_program(folder, NULL, NULL, (const char *const[]){"/bin/sh", "-c", line, NULL});
}

static void run(const char *line)
{
    program_run r = shell(line);
    if (r.status != 0) fail_msg("%s\nstatus %d\nstdout:\n%s\nstderr:\n%s", line, r.status, r.out, r.err);
    program_run_free(&r);
}

static int setup(void **state)
{
    make_scene_folder(state);
    write_text(in_folder(folder, "environment"), environment);
    write_text(in_folder(folder, "remote_shell"), remote_shell);
    run("chmod +x remote_shell");
    setenv("MPIRUN", FACET_MPIRUN, 1);
    setenv("FACET", FACET_PROGRAM, 1);
    return 0;
}

static int teardown(void **state)
{
    (void)state;
    program_run r = shell(". ./environment; ip netns delete $A; ip netns delete $B");
    program_run_free(&r);
    remove_folder(folder);
    return 0;
}

/* Bytes that the first machine has got through the cable. */
static unsigned long bytes_received(void)
{
    program_run r = shell(". ./environment; ip netns exec $A cat /sys/class/net/eth0/statistics/rx_bytes");
    if (r.status != 0) fail_msg("%s", r.err);
    const unsigned long n = strtoul(r.out, NULL, 10);
    program_run_free(&r);
    return n;
}

static void two_machines_give_the_bits_of_one_process(void **state)
{
    (void)state;
    if (!FACET_MPIRUN[0]) {
        print_message("skipped: facet was built without MPI, or there is no mpirun\n");
        skip();
    }
    program_run made = shell(make_machines);
    const bool has_machines = made.status == 0;
    program_run_free(&made);
    if (!has_machines) {
        print_message("skipped: no network namespaces here: they need root, and the package iproute2\n");
        skip();
    }
    run("$FACET render scene.gltf --size 384x192 --quiet --spp 12 -o one.exr");
    const unsigned long before = bytes_received();
    run(". ./environment\n"
        "case $MPIRUN in\n"
        "*openmpi*) set -- --allow-run-as-root -H 10.77.0.1:1,10.77.0.2:1;;\n"
        "*) set -- -launcher ssh -launcher-exec $PWD/remote_shell -iface eth0 -hosts 10.77.0.1,10.77.0.2 -ppn 1;;\n"
        "esac\n"
        "exec ip netns exec $A unshare --uts sh -c 'hostname $A; exec \"$@\"' sh $MPIRUN \"$@\" -n 2 "
        "$FACET render scene.gltf --size 384x192 --threads 1 --spp 12 -o two.exr --json");
    const double n = (double)(bytes_received() - before), whole = 384.*192*sizeof(film_pixel);
    print_message("%.1f MB of a film of %.1f MB came through the cable\n", 1e-6*n, 1e-6*whole);
    assert_true(n > whole/4); /* a machine that rendered a fair share has most pixels */
    assert_same_pixels(folder, "one.exr", "two.exr");
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(two_machines_give_the_bits_of_one_process)};
    return cmocka_run_group_tests_name("mpi_network", tests, setup, teardown);
}

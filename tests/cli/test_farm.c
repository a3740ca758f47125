/* test_farm.c: the job scripts of examples/farm, run with stand-ins for Slurm's and OpenCue's programs: the picture is
 * that of one render, though jobs come in any order and are stopped and requeued.
 * SPDX-License-Identifier: MIT */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
/* cmocka needs the headers above */
#include <cmocka.h>

#include "tests/picture_bytes.h"
#include "tests/program_folder.h"

#define FARM FACET_SOURCE_DIR "/examples/farm/"

/* Runs an array's tasks from the last to the first.  Each is sent SIGTERM once, at a time of its own, as before its
 * time limit, until it ends without asking to be requeued. */
static const char fake_sbatch[] =
    "#!/bin/sh\n"
    "echo \"$@\" >> sbatch.log\n"
    "array= dependency=\n"
    "while :; do\n"
    "    case $1 in\n"
    "    */*) break;;\n"
    "    --array=*) array=${1#--array=1-};;\n"
    "    --dependency=*) dependency=$1;;\n"
    "    --*) ;;\n"
    "    *) break;;\n"
    "    esac\n"
    "    shift\n"
    "done\n"
    "export SLURM_JOB_ID=17\n"
    "if [ -z \"$array\" ]; then\n"
    "    test \"$dependency\" = --dependency=afterok:17 && \"$@\" >&2 && echo 18\n"
    "    exit\n"
    "fi\n"
    "export SLURM_ARRAY_JOB_ID=17\n"
    "for k in $(seq \"$array\" -1 1); do\n"
    "    delay=0.0$k\n"
    "    while :; do\n"
    "        rm -f requeued\n"
    "        SLURM_ARRAY_TASK_ID=$k \"$@\" >&2 &\n"
    "        job=$!\n"
    "        (sleep \"$delay\"; kill -TERM \"$job\") >/dev/null 2>&1 &\n"
    "        status=0\n"
    "        wait \"$job\" || status=$?\n"
    "        test -e requeued || test $status = 143 || break\n" /* before it had its trap */
    "        test $status = 143 || test \"$(cat requeued)\" = \"requeue 17_$k\" || exit 1\n"
    "        delay=9\n"
    "    done\n"
    "    test $status = 0 || exit 1\n"
    "done\n"
    "echo '17;cluster'\n";

static const char fake_scontrol[] = "#!/bin/sh\necho \"$@\" > requeued\necho \"$@\" >> scontrol.log\n";

/* pyoutline's part in the script, running what it is given at once. */
static const char fake_outline[] =
    "import subprocess, sys, types\n"
    "class Shell:\n"
    "    def __init__(self, name, command, range, threadable=False):\n"
    "        self.command, self.range, self.needs = command, [int(x) for x in range.split('-')], []\n"
    "    def depend_all(self, other):\n"
    "        self.needs.append(other)\n"
    "    def run(self):\n"
    "        for need in self.needs: need.run()\n"
    "        for frame in reversed(range(self.range[0], self.range[-1] + 1)):\n"
    "            subprocess.run([word.replace('#IFRAME#', str(frame)) for word in self.command], check=True)\n"
    "class Outline:\n"
    "    def __init__(self, name, show, shot, user): self.layers = []\n"
    "    def add_layer(self, layer): self.layers.append(layer)\n"
    "def launch(job, use_pycuerun): job.layers[-1].run()\n"
    "for name in ('cuerun', 'modules', 'modules.shell'):\n"
    "    sys.modules['outline.' + name] = types.ModuleType(name)\n"
    "cuerun, modules = sys.modules['outline.cuerun'], sys.modules['outline.modules']\n"
    "cuerun.launch, modules.shell = launch, sys.modules['outline.modules.shell']\n"
    "modules.shell.Shell = Shell\n";

static void shell(const char *line)
{
    char command[4096];
    snprintf(command, sizeof command, "export PATH=\"$PWD/bin:$(dirname '%s'):$PATH\" PYTHONPATH=\"$PWD/bin\"; %s",
             FACET_PROGRAM, line);
    program_run run = run_program(folder, NULL, NULL, (const char *const[]){"/bin/sh", "-ec", command, NULL});
    if (run.status != 0) fail_msg("%s\nstatus %d\n%s%s", line, run.status, run.out, run.err);
    program_run_free(&run);
}

static int setup(void **state)
{
    make_scene_folder(state);
    shell("mkdir bin");
    write_text(in_folder(folder, "bin/sbatch"), fake_sbatch);
    write_text(in_folder(folder, "bin/scontrol"), fake_scontrol);
    write_text(in_folder(folder, "bin/outline.py"), fake_outline);
    shell("chmod +x bin/sbatch bin/scontrol; facet render scene.gltf --size 64x32 --spp 600 --quiet -o whole.exr");
    return 0;
}

static void slurm_renders_and_merges_an_array(void **state)
{
    (void)state;
    shell(FARM "slurm.sh 3 scene.gltf slurm.exr --size 64x32 --spp 600 --quiet --threads 1");
    assert_same_pixels(folder, "whole.exr", "slurm.exr");
    shell("grep -q -- '--array=1-3' sbatch.log; grep -q requeue scontrol.log");
    shell("! " FARM "slurm.sh 3 2>usage; grep -q 'slurm.sh N SCENE OUT.exr' usage");
}

static void make_renders_and_merges_shards(void **state)
{
    (void)state;
    static const char line[] = "make -s -f " FARM "shards.mk -j 2 SCENE=scene.gltf OUT=make.exr N=5 "
                               "OPTIONS='--size 64x32 --spp 600 --quiet --threads 1'";
    shell(line);
    assert_same_pixels(folder, "whole.exr", "make.exr");
    shell("rm make.exr make.exr.2.ckpt");
    shell(line);
    assert_same_pixels(folder, "whole.exr", "make.exr");
}

static void opencue_renders_frames_and_merges_them(void **state)
{
    (void)state;
    shell("python3 -B " FARM "opencue.py 4 scene.gltf cue.exr --size 64x32 --spp 600 --quiet");
    assert_same_pixels(folder, "whole.exr", "cue.exr");
}

static void the_shell_script_is_clean(void **state)
{
    (void)state;
    shell("sh -n " FARM "slurm.sh; if command -v shellcheck; then shellcheck " FARM "slurm.sh; fi");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(slurm_renders_and_merges_an_array),
        cmocka_unit_test(make_renders_and_merges_shards),
        cmocka_unit_test(opencue_renders_frames_and_merges_them),
        cmocka_unit_test(the_shell_script_is_clean),
    };
    return cmocka_run_group_tests_name("farm", tests, setup, remove_test_folder);
}

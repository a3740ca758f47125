#!/bin/sh
# Renders a scene as an array of N Slurm jobs, and merges them when all are done:
#
#     examples/farm/slurm.sh N SCENE OUT.exr [OPTION OF facet render]...
#     SBATCH_PARTITION=render SBATCH_TIMELIMIT=4:00:00 examples/farm/slurm.sh 100 scene.glb scene.exr --spp 4096
#
# OUT.exr.K.ckpt is shard K.  A job that is preempted, or out of time in a minute, saves it and goes back to the queue;
# a job whose node died is started again by Slurm.  Either goes on where it was.
#
# SPDX-License-Identifier: MIT
set -eu

submit()
{
    shards=$(sbatch --parsable --job-name=facet --array="1-$1" --requeue --open-mode=append --signal=B:TERM@60 \
        "$0" --shard "$@")
    sbatch --parsable --job-name=facet-merge --dependency="afterok:${shards%%;*}" "$0" --merge "$@"
}

# Slurm's signal goes to this shell alone, which stays to pass it on and to requeue the job.
shard()
{
    n=$1 scene=$2 out=$3 child='' stopped=''
    shift 3
    checkpoint=$out.$SLURM_ARRAY_TASK_ID.ckpt
    trap 'stopped=1; [ -z "$child" ] || kill -TERM "$child"' TERM
    facet render "$scene" --shard "$SLURM_ARRAY_TASK_ID/$n" --checkpoint "$checkpoint" --resume "$checkpoint" "$@" &
    child=$!
    [ -z "$stopped" ] || kill -TERM "$child"
    status=0
    wait "$child" || status=$?
    while kill -0 "$child" 2>/dev/null; do # the signal ended the waiting, not yet the render
        status=0
        wait "$child" || status=$?
    done
    if [ -n "$stopped" ] && [ "$status" -ne 0 ]; then
        scontrol requeue "${SLURM_ARRAY_JOB_ID}_$SLURM_ARRAY_TASK_ID"
    fi
    exit "$status"
}

merge()
{
    n=$1 out=$3
    shift "$#"
    for k in $(seq "$n"); do set -- "$@" "$out.$k.ckpt"; done
    facet merge "$@" -o "$out"
}

role=submit
case ${1:-} in
--shard | --merge) role=${1#--} && shift ;;
esac
if [ "$#" -lt 3 ]; then
    sed -n '2,/^$/s/^# \{0,1\}//p' "$0" >&2
    exit 2
fi
"$role" "$@"

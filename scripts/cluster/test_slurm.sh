#!/bin/bash
# The workflow on a real Slurm of this machine's own: one node, two tasks at a time. A job is killed on the way; the picture must have the bytes of one run on one machine.
#   scripts/cluster/test_slurm.sh [LRSM]        default build/release/apps/lrsm
# Needs the Debian packages slurm-wlm, munge and snakemake; without them it says SKIPPED and exits with 0. Daemons, keys and state live in a folder of their own and end with the script.
set -euo pipefail
cluster=$(cd "$(dirname "$0")" && pwd)
lrsm=$(realpath "${1:-$cluster/../../build/release/apps/lrsm}")
export PATH=$PATH:/usr/sbin
for program in munged slurmctld slurmd sbatch snakemake; do
    if ! command -v $program >/dev/null; then
        echo "test_slurm: SKIPPED: no $program (Debian: slurm-wlm munge snakemake)"
        exit 0
    fi
done

dir=$(mktemp -d)
chmod 755 "$dir"
export SLURM_CONF=$dir/slurm.conf
host=$(hostname -s)
user=$(id -un)
end() {
    result=$?
    [ ! -f "$dir/jobs" ] || kill "$(cat "$dir/jobs")" 2>/dev/null || true
    for pid in slurmd slurmctld munged; do [ ! -f "$dir/$pid.pid" ] || kill "$(cat "$dir/$pid.pid")" 2>/dev/null || true; done
    [ $result = 0 ] || tail -n 20 "$dir"/*.log >&2
    sleep 1
    rm -rf "$dir"
    exit $result
}
trap end EXIT

# One node that this machine is.
port=$((20000 + $$ % 20000))
head -c 1024 /dev/urandom >"$dir/munge.key"
chmod 400 "$dir/munge.key"
cat >"$SLURM_CONF" <<END
ClusterName=test
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$port
SlurmdPort=$((port + 1))
SlurmUser=$user
SlurmdUser=$user
AuthType=auth/munge
CredType=cred/munge
AuthInfo=socket=$dir/munge.socket
StateSaveLocation=$dir/state
SlurmdSpoolDir=$dir/spool
SlurmctldPidFile=$dir/slurmctld.pid
SlurmdPidFile=$dir/slurmd.pid
SlurmctldLogFile=$dir/slurmctld.log
SlurmdLogFile=$dir/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerParameters=sched_interval=2,batch_sched_delay=0
ReturnToService=2
MailProg=/bin/true
NodeName=$host NodeAddr=127.0.0.1 CPUs=2 State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES State=UP
END
mkdir "$dir/state" "$dir/spool"
munged --force --key-file="$dir/munge.key" --socket="$dir/munge.socket" --pid-file="$dir/munged.pid" --log-file="$dir/munged.log" --seed-file="$dir/munge.seed" 2>/dev/null
slurmctld
slurmd -N "$host"
for _ in $(seq 60); do
    ! sinfo -h -o %T 2>/dev/null | grep -q idle || break
    sleep 0.5
done
sinfo -h -o %T | grep -q idle
echo "test_slurm: $(slurmd -V) is up after $SECONDS s"

# What one machine makes of it.
picture="--size 320x180 --block 16"
"$lrsm" reference cornell-box $picture --spp "${SPP:-512}" --threads 2 --quiet -o "$dir/single"
echo "test_slurm: one machine is done after $SECONDS s"

cat >"$dir/my.yaml" <<END
lrsm: $lrsm
threads: 1
checkpoint_seconds: 1
reference: {options: "$picture", spp: ${SPP:-512}, samples_per_job: $((${SPP:-512} / 4))}
END
cd "$dir"
snakemake reference -s "$cluster/Snakefile" --profile "$cluster/slurm" --latency-wait 5 --directory "$dir/work" --configfile "$dir/my.yaml" >"$dir/snakemake.log" 2>&1 &
echo $! >"$dir/jobs"

# The first job that has something to lose is killed.
killed=""
for _ in $(seq 200); do
    for samples in "$dir"/work/samples/*/samples.bin; do
        [ -f "$samples" ] || continue
        range=$(basename "$(dirname "$samples")")
        job=$(squeue -h -t R -o '%i %o' | while read -r id script; do if scontrol write batch_script "$id" - 2>/dev/null | grep -q "samples/$range"; then echo "$id"; fi; done | head -n 1)
        [ -n "$job" ] && [ ! -f "$dir/work/samples/$range/frame.json" ] || continue
        scancel --full --signal=KILL "$job"
        killed="$job, samples $range"
        break 2
    done
    sleep 0.1
done
[ -n "$killed" ] || { echo "test_slurm: FAILED: no job could be killed"; exit 1; }
echo "test_slurm: killed job $killed"
wait "$(cat "$dir/jobs")" || { echo "test_slurm: FAILED: snakemake"; exit 1; }
rm "$dir/jobs"
echo "test_slurm: two tasks of Slurm are done after $SECONDS s"

grep -q "Trying to restart job" "$dir/snakemake.log" || { echo "test_slurm: FAILED: nothing was tried again"; exit 1; }
for file in image.exr samples.bin; do cmp "$dir/single/$file" "$dir/work/reference/$file" || { echo "test_slurm: FAILED: $file differs"; exit 1; }; done
echo "test_slurm: passed in $SECONDS s: a killed job was tried again, image.exr and samples.bin are the single machine's"

#!/usr/bin/env bash
# slurm_lab.sh up FOLDER NODES | node FOLDER NAME | lose FOLDER NAME | controller FOLDER | down FOLDER
# A Slurm of one's own on loopback, without systemd: a controller and as many nodes as wanted. Leaves the machine's own
# Slurm alone, if there is one. `node` starts another node (s3 …); `lose` kills one with all that runs on it;
# `controller` starts another controller after the first has died.
# Exit code 77: it can't be had here.
set -euo pipefail
export PATH=/usr/sbin:/usr/bin:/sbin:/bin
command=$1 folder=$2
export SLURM_CONF=$folder/slurm.conf
most_nodes=4

start() {  # NAME PROGRAM WORDS...: in the background, its pid kept
    local name=$1
    shift
    setsid "$@" >"$folder/log/$name.out" 2>&1 </dev/null &
    echo $! >"$folder/run/$name.pid"
}

start_node() {
    mkdir -p "$folder/spool/$1"
    start "$1" slurmd -D -N "$1"
}

free_port() { python3 -c 'import socket; s = socket.socket(); s.bind(("127.0.0.1", 0)); print(s.getsockname()[1])'; }

up() {
    for program in munged slurmctld slurmd sbatch scancel python3; do
        command -v "$program" >/dev/null || { echo "there is no $program here"; exit 77; }
    done
    [ "$(id -u)" = 0 ] || { echo "it takes root"; exit 77; }
    mkdir -p "$folder"/{state,log,spool,munge,run}
    chmod 755 "$folder" "$folder/run"
    chmod 700 "$folder/munge"
    dd if=/dev/urandom of="$folder/munge/key" bs=1 count=1024 status=none
    chmod 400 "$folder/munge/key"
    munged --force --key-file="$folder/munge/key" --socket="$folder/run/munge.sock" --num-threads=1 \
        --pid-file="$folder/run/munged.pid" --log-file="$folder/log/munged" --seed-file="$folder/munge/seed"
    local name
    name=$(hostname -s)
    cat >"$folder/slurm.conf" <<CONF
ClusterName=lab
SlurmctldHost=$name(127.0.0.1)
SlurmUser=root
SlurmdUser=root
AuthInfo=socket=$folder/run/munge.sock
CommunicationParameters=NoInAddrAny,NoCtldInAddrAny
SlurmctldPort=$(free_port)
SlurmctldPidFile=$folder/run/ctld
SlurmdPidFile=$folder/run/%n.slurmd
SlurmctldLogFile=$folder/log/slurmctld
SlurmdLogFile=$folder/log/%n
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool/%n
MpiDefault=none
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
AccountingStorageType=accounting_storage/none
SchedulerParameters=bf_interval=2,sched_interval=1
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SlurmdParameters=config_overrides
ReturnToService=2
SlurmctldTimeout=10
SlurmdTimeout=5
KillWait=2
RebootProgram=/bin/true
CONF
    for i in $(seq 1 $most_nodes); do
        echo "NodeName=s$i NodeHostname=$name NodeAddr=127.0.0.1 Port=$(free_port) CPUs=1 RealMemory=500"
    done >>"$folder/slurm.conf"
    echo "PartitionName=main Nodes=s[1-$most_nodes] Default=YES MaxTime=INFINITE State=UP" >>"$folder/slurm.conf"
    start slurmctld slurmctld -D -i
    for i in $(seq 1 "$1"); do start_node "s$i"; done
    for _ in $(seq 1 100); do
        [ "$(sinfo -h -N -t idle -o %N 2>/dev/null | wc -l)" -ge "$1" ] && return
        sleep 0.2
    done
    tail -n 5 "$folder"/log/*
    exit 77
}

below() {  # all processes below one
    local child
    for child in $(pgrep -P "$1" || true); do
        below "$child"
        echo "$child"
    done
}

lose() {
    local pid
    pid=$(cat "$folder/run/$1.pid")
    # steps are no children of the daemon: they carry the node's name in their own
    local steps
    steps=$(pgrep -f "slurmstepd: .*" || true)
    kill -KILL "$pid"
    for step in $steps; do
        tr '\0' '\n' <"/proc/$step/environ" 2>/dev/null | grep -q "^SLURM_CONF=$folder/" || continue
        local child
        for child in $(below "$step"); do
            tr '\0' '\n' <"/proc/$child/environ" 2>/dev/null | grep -q "^SLURMD_NODENAME=$1$" || continue
            kill -KILL "$child" "$step" 2>/dev/null || true
        done
    done
}

down() {
    scancel --user=root 2>/dev/null || true
    local file pid
    for signal in TERM KILL; do
        for file in "$folder"/run/*.pid; do
            pid=$(cat "$file" 2>/dev/null) || continue
            case $(cat "/proc/$pid/comm" 2>/dev/null) in
                munged | slurmctld | slurmd) kill -$signal "$pid" 2>/dev/null || true ;;
            esac
        done
        sleep 0.5
    done
    local step  # those whose controller is gone would wait for it
    for step in $(pgrep -f "slurmstepd: " || true); do
        tr '\0' '\n' <"/proc/$step/environ" 2>/dev/null | grep -q "^SLURM_CONF=$folder/" || continue
        kill -KILL $(below "$step") "$step" 2>/dev/null || true
    done
}

case $command in
    up) up "$3" ;;
    node) start_node "$3" ;;
    lose) lose "$3" ;;
    controller) start slurmctld slurmctld -D -i ;;
    down) down ;;
esac

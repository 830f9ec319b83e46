#!/bin/sh
# make_keys.sh FOLDER: keys for a farm of containers, made once. What is there stays.
#
#   launcher    the launcher's secret key
#   farm        the daemons' secret key, the same for all of them
#   farm.keys   whom the launcher lets join: the daemons' public key, and names like lightnetd-1
#
# Prints the launcher's public key, which the daemons are told (LIGHTNET_LAUNCHER_KEY).
set -eu
folder=${1:?usage: $0 FOLDER}
mkdir -p "$folder"
chmod 700 "$folder"
printf %s "$(lightnet key --key "$folder/launcher" 2>/dev/null | cut -d' ' -f1)" >"$folder/launcher.pub"
printf %s "$(lightnetd --key "$folder/farm" --print-key 2>/dev/null)" >"$folder/farm.pub"
[ -s "$folder/launcher.pub" ] && [ -s "$folder/farm.pub" ] || {
    echo "no keys can be made in $folder" >&2
    exit 1
}
[ -e "$folder/farm.keys" ] || {
    umask 077
    echo "$(cat "$folder/farm.pub") lightnetd-*" >"$folder/farm.keys"
}
echo "LIGHTNET_LAUNCHER_KEY=$(cat "$folder/launcher.pub")"

#!/usr/bin/env bash
# Makes the pictures, the robot's file and the figures of README.md anew; the recordings are not part of the project.
# usage: HEATSOAK_MEASURED_DATA=folder reports/friction/make.sh
set -euo pipefail
cd "$(dirname -- "${BASH_SOURCE[0]}")/../.."
heatsoak=${HEATSOAK:-build/release/bin/heatsoak}
data=${HEATSOAK_MEASURED_DATA:?names the folder of the recordings}
out=reports/friction
robotino=(--robot tests/data/robots/festo_robotino.toml --motor tests/data/motors/robotino_motor.toml
          --map tests/data/mappings/robotino_omni.map.toml)
for surface in table brown green; do
  extra=()
  [ "$surface" = green ] && extra=(--out "$out/robotino_on_carpet.toml")
  "$heatsoak" friction "${robotino[@]}" "$data/robotino_omni/${surface}_surface"/exp*.csv --plot "$out/$surface.svg" "${extra[@]}"
done
"$heatsoak" lint "$out/robotino_on_carpet.toml"
"$heatsoak" friction --robot tests/data/robots/a_team_on_blocks.toml --map tests/data/mappings/ateam_wheel_motor.map.toml \
  "$data/ateam_wheel_motor"/*.csv --plot "$out/wheel_motors.svg"

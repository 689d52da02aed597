#!/usr/bin/env bash
# Repeats every diagnosis of this folder: prints the answers for the pages, and makes their models and pictures anew. The recordings are not
# part of the project.
# usage: HEATSOAK_MEASURED_DATA=folder reports/diagnosis/make.sh
set -euo pipefail
cd "$(dirname -- "${BASH_SOURCE[0]}")/../.."
heatsoak=${HEATSOAK:-build/release/bin/heatsoak}
data=${HEATSOAK_MEASURED_DATA:?names the folder of the recordings}
reports=reports/diagnosis
made=$(mktemp -d)
trap 'rm -rf "$made"' EXIT

# Prints the paragraphs of an answer without its notes. The first argument is its title, the rest is the command.
answer() {
  printf '\n== %s\n' "$1"
  shift
  local code=0
  "$heatsoak" "$@" > "$made/answer.txt" || code=$?
  sed "/^- /,\$d" "$made/answer.txt"
  [ $code -le 1 ] || [ $code = 3 ] || exit $code  # 3: the runs do not decide
}

uav=$data/tasrv_uav_motor
uav_map=$reports/uav_fan/recordings.map.toml
mkdir "$made"/{forecast,innovations}
for fit in forecast innovations; do
  "$heatsoak" calibrate --$fit --motor $reports/uav_motor.toml --map $uav_map "$uav"/run{1,3,5}.csv --out "$made/$fit/uav_motor.toml" --quiet
  for cut in 50 60 65 70; do
    answer "drone motor, --$fit, run 4 to $cut %" diagnose --model "$made/$fit/uav_motor.toml" --map $uav_map \
      --train "$uav"/run{1,3,5}.csv "$uav/run4.csv@0-$cut%" --holdout "$uav/run4.csv@$cut-100%" "$uav/run2.csv" --out "$made/uav_${fit}_$cut"
  done
done
cp "$made"/uav_forecast_60/{diagnosis.html,diagnosis.json,residual_K.svg,unknown_heat_W.svg,uav_motor.toml} $reports/uav_fan/

traction=$data/paderborn_pmsm/profile24_2.5s.csv
for cut in 50 55 60 65 70 75; do
  answer "traction motor, first $cut %" diagnose --model $reports/traction_motor/start.toml --map $reports/traction_motor/recording.map.toml \
    --train "$traction@0-$cut%" --holdout "$traction@$cut-100%" --out "$made/traction_$cut"
done
cp "$made/traction_70/residual_K.svg" $reports/traction_motor/
cp "$made/traction_70/start.toml" $reports/traction_motor/extended.toml

ri50=$data/umich_ri50
ri50_map=tests/data/mappings/umich_ri50.map.toml
"$heatsoak" calibrate --innovations --motor reports/calibration/ri50.toml --map $ri50_map --ambient 22degC "$ri50/stall_staircase.csv" \
  --out "$made/ri50.toml" --quiet
answer "frameless motor" diagnose --model "$made/ri50.toml" --map $ri50_map --ambient 22degC \
  --train "$ri50/stall_staircase.csv" "$ri50/no_load_staircase.csv@0-60%" --holdout "$ri50/no_load_staircase.csv@60-100%" --out "$made/ri50"
cp "$made/ri50/residual_K.svg" $reports/frameless_motor/
cp "$made/ri50/ri50.toml" $reports/frameless_motor/extended.toml

bench=$data/ksu_propeller_bench
bench_map=$reports/propeller_bench/recordings.map.toml
bench_start=$reports/propeller_bench/start.toml
sed 's/stator_C = { column/winding_C = { column/' $bench_map > "$made/winding.map.toml"
january=$bench/cooling_slopes__Spike-Mega-1700_2020-01-27_105922.csv
march=$bench/cooling_slopes__Spike-Mega-1700_2020-03-05_145559.csv
for map in $bench_map "$made/winding.map.toml"; do
  name=$(basename "$map" .map.toml)
  answer "Mega, January, $name" diagnose --model $bench_start --map "$map" --train "$january" --holdout "$march" --out "$made/mega_$name"
  answer "Mega, March, $name" diagnose --model $bench_start --map "$map" --train "$march" --holdout "$january"
done
cp "$made/mega_recordings/residual_K.svg" $reports/propeller_bench/
cp "$made/mega_recordings/start.toml" $reports/propeller_bench/extended.toml
kde=$bench/custom_head_testing__HeadBaseline-KDE-2000_2020-02-13_160050.csv
p80=$bench/cooling_slopes__Spike-P80-1700
files=("${p80}_2020-02-11_162559.csv" "${p80}_2020-03-09_185035.csv" "${p80}_2020-03-10_133951.csv")
for log in "$kde" "${files[@]}"; do
  answer "$(basename "$log" .csv), first 70 %" diagnose --model $bench_start --map $bench_map --train "$log@0-70%" --holdout "$log@70-100%"
done
for unseen in 0 1 2; do
  train=()
  for i in 0 1 2; do [ $i = $unseen ] || train+=("${files[$i]}"); done
  answer "P80, all but file $((unseen + 1))" diagnose --model $bench_start --map $bench_map --train "${train[@]}" --holdout "${files[$unseen]}"
done

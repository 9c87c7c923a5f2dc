#!/usr/bin/env bash
# The tools one after the other, as a user would run them, and what they say to wrong input.
# Usage: tools_test.sh <folder of the programs> <source folder>
set -euo pipefail
bin=$1 source=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

fail() { echo "FAILED: $*" >&2; exit 1; }
# refused <exit code> <text that the error must hold> <command...>
refused() {
  local code=$1 text=$2 got=0
  shift 2
  "$@" >out.txt 2>&1 || got=$?
  [ "$got" -eq "$code" ] || { cat out.txt >&2; fail "exit code $got, not $code: $*"; }
  grep -q -- "$text" out.txt || { cat out.txt >&2; fail "'$text' is missing from the error of: $*"; }
}

"$bin/simulate" --scenario "$source/test/ros/scenario.yaml" --out drive.bag --duration 4
"$bin/replay" --site "$source/test/ros/site.yaml" --bag drive.bag --out drive.csv --out-bag result.bag
"$bin/evaluate" --truth drive.bag --estimate drive.csv --json drive.json --plot drive.png --site "$source/test/ros/site.yaml"
[ -s result.bag ] || fail "no --out-bag"
[ -s drive.png ] || fail "no plot"
header=stamp_s,x_m,y_m,z_m,roll_rad,pitch_rad,yaw_rad,sigma_x_m,sigma_y_m,sigma_yaw_rad,beacons_used,mode
[ "$(head -n 1 drive.csv)" = "$header" ] || fail "the CSV's columns are not those of the interfaces page"
/usr/bin/python3 - <<'PYTHON'
import json
result = json.load(open("drive.json"))
parts = {"mean_m", "rmse_m", "median_m", "p95_m", "max_m"}
for key in ("all", "standing", "moving"):
    assert parts <= set(result[key]["position"]), result[key]
    assert {part.replace("_m", "_rad") if part != "mean_m" else "mean_rad" for part in parts} <= set(result[key]["yaw"])
    assert {"samples", "nees_mean", "z"} <= set(result[key])
assert result["all"]["samples"] > 80, result
assert result["all"]["position"]["mean_m"] < 0.08, result
assert result["availability"] >= 0.99, result
assert result["time_to_first_fix_s"] < 1.5, result
PYTHON

# The other kind of receiver hands over samples: they are demodulated, and without them blobs have no names.
sed "s|site: site.yaml|site: $source/test/ros/site.yaml|; s|^ir: {|ir: {samples: true, |" "$source/test/ros/scenario.yaml" >samples.yaml
grep -q "samples: true" samples.yaml || fail "the scenario has no ir section to ask for samples in"
"$bin/simulate" --scenario samples.yaml --out samples.bag --duration 3
"$bin/replay" --site "$source/test/ros/site.yaml" --bag samples.bag --out samples.csv | tee samples.txt
"$bin/evaluate" --truth samples.bag --estimate samples.csv --json samples.json
/usr/bin/python3 - <<'PYTHON'
import json
result = json.load(open("samples.json"))
assert result["all"]["samples"] > 50 and result["all"]["position"]["mean_m"] < 0.08, result
assert result["availability"] >= 0.99 and result["time_to_first_fix_s"] < 1.5, result
PYTHON

# Nothing found is an answer, not an error.
head -n 1 drive.csv >empty.csv
"$bin/evaluate" --truth drive.bag --estimate empty.csv --json empty.json
/usr/bin/python3 -c 'import json; r = json.load(open("empty.json")); assert r["all"]["samples"] == 0 and r["time_to_first_fix_s"] is None, r'

camera="--fps 30 --window 30 --mains 50"
cat >survey.yaml <<'YAML'
site: {name: survey}
beacons: [{id: 1, position_m: [2, 2, 8]}, {id: 2, position_m: [9, 2, 8]}, {id: 3, position_m: [60, 2, 8]}]
YAML
"$bin/plan_codes" $camera --waveform sine --beacons survey.yaml --out planned.yaml --plot planned.png | tee plan.txt
grep -q "carries .* beacons/m2" plan.txt || fail "plan_codes does not say how many beacons it can carry"
[ -s planned.png ] || fail "no plot of the plan"
"$bin/replay" --site planned.yaml --bag drive.bag --out planned.csv
refused 1 "2 codes" "$bin/plan_codes" --fps 10 --window 5 --mains 50 --waveform square --beacons survey.yaml
refused 1 "survey.yaml: beacon 1 hangs" "$bin/plan_codes" $camera --waveform sine --beacons survey.yaml --camera-height 9
refused 1 "use --slots 2" "$bin/plan_codes" $camera --waveform sine --beacons survey.yaml --slots 1
refused 1 "sine or square" "$bin/plan_codes" $camera --waveform saw --beacons survey.yaml

head -c 20000 drive.bag >torn.bag
refused 1 torn.bag "$bin/replay" --site "$source/test/ros/site.yaml" --bag torn.bag --out e.csv
refused 1 nothere.bag "$bin/replay" --site "$source/test/ros/site.yaml" --bag nothere.bag --out e.csv
refused 1 "site_alias.yaml:3" "$bin/replay" --site "$source/test/ros/site_alias.yaml" --bag drive.bag --out e.csv
refused 2 "--help" "$bin/replay" --sight x
refused 2 "site" "$bin/replay" --bag drive.bag --out e.csv
sed 's/^\([0-9.]*\),[^,]*/\1,nan/' drive.csv >nan.csv
refused 1 "nan.csv:2" "$bin/evaluate" --truth drive.bag --estimate nan.csv
refused 1 "duration" "$bin/accuracy" --scenario "$source/test/ros/scenario.yaml" --duration nan
"$bin/simulate" --scenario "$source/config/scenarios/fixes.yaml" --out fixes.bag --duration 20
"$bin/fuse" --bag fixes.bag --out fixes.csv
"$bin/evaluate" --truth fixes.bag --estimate fixes.csv --json fixes.json
/usr/bin/python3 -c 'import json; r = json.load(open("fixes.json"))["all"]; assert r["samples"] > 900 and r["position"]["rmse_m"] < 0.05, r'
refused 1 "beacons/fix" "$bin/fuse" --bag drive.bag --out e.csv
refused 1 "no camera" "$bin/accuracy" --scenario "$source/config/scenarios/fixes.yaml" --seeds 1

tools="simulate replay fuse evaluate paper_experiment accuracy plan_codes"
if [ -x "$bin/calibrate" ]; then
  tools="$tools calibrate calibrate_mount"
  chessboard="--board chessboard --size 10x8 --square-m 0.03"
  mkdir shots
  "$bin/make_board_views" shots 12
  "$bin/calibrate" --images shots $chessboard --out camera.yaml --plot coverage.png | tee lens.txt
  [ -s coverage.png ] || fail "no coverage plot"
  grep -q "no view in the upper left corner" lens.txt || fail "calibrate does not warn of a corner without a view"
  if grep -q "above the limit" lens.txt; then fail "calibrate warns of a lens that is known well enough"; fi
  mkdir few
  cp shots/shot_10[0-3].png few
  "$bin/calibrate" --images few $chessboard --out few.yaml | tee few.txt
  grep -q "^warning    focal: one sigma is .* above the limit of 0.05 %" few.txt || fail "calibrate does not warn of a weak lens"
  /usr/bin/python3 - <<'PYTHON'
import yaml
info = yaml.safe_load(open("camera.yaml"))
fx, fy = info["camera_matrix"]["data"][0], info["camera_matrix"]["data"][4]
assert abs(fx / 229.4 - 1) < 0.002 and abs(fy / 229.4 - 1) < 0.002, info
assert info["distortion_model"] == "equidistant" and info["image_width"] == 640, info
PYTHON
  "$bin/make_board_views" board.bag 32
  "$bin/calibrate" --images board.bag $chessboard --out recorded.yaml
  /usr/bin/python3 - <<'PYTHON'
import yaml
fx, _, cx, _, fy, cy = yaml.safe_load(open("recorded.yaml"))["camera_matrix"]["data"][:6]
assert abs(fx / 229.4 - 1) < 0.0005 and abs(fy / 229.4 - 1) < 0.0005, (fx, fy)
assert abs(cx - 319.5) < 0.1 and abs(cy - 239.5) < 0.1, (cx, cy)
PYTHON
  refused 1 "at least 4" "$bin/calibrate" --images drive.bag $chessboard
  mkdir torn
  for shot in shots/*; do head -c 200 "$shot" >torn/shot.png; done
  refused 1 "no image that can be read" "$bin/calibrate" --images torn $chessboard
  refused 1 "COLUMNSxROWS" "$bin/calibrate" --images shots --board chessboard --size 10by8 --square-m 0.03
  refused 1 "3 to 100" "$bin/calibrate" --images shots --board chessboard --size 2x8 --square-m 0.03
  refused 1 "chessboard, charuco or aprilgrid" "$bin/calibrate" --images shots --board poster --size 10x8 --square-m 0.03

  # The truth is the scenario's mount; the guess is off by degrees.
  "$bin/simulate" --scenario "$source/test/tools/mount.yaml" --out mount.bag
  echo "camera: {mount: {xyz_m: [0.2, 0.0, 1.5], rpy_deg: [0, 0, 0]}, calibration_sigma_px: 0.1}" >guess.yaml
  "$bin/calibrate_mount" --site "$source/test/ros/site.yaml" --bag mount.bag --vehicle guess.yaml | tee mount.txt
  /usr/bin/python3 - <<'PYTHON'
import re
found = {m[0]: (float(m[1]), float(m[2])) for m in re.findall(r"(roll|pitch|yaw) +(\S+) deg, one sigma (\S+)", open("mount.txt").read())}
for angle, truth, widest in (("roll", 1.2, 0.15), ("pitch", -0.8, 0.15), ("yaw", 2.0, 0.5)):
    value, sigma = found[angle]
    assert abs(value - truth) < 3 * sigma and sigma < widest, (angle, value, sigma)
PYTHON
  if grep -q "^warning" mount.txt; then fail "calibrate_mount warns of a yaw that is good enough"; fi
  "$bin/calibrate_mount" --site "$source/test/ros/site.yaml" --bag mount.bag --vehicle guess.yaml --yaw-limit-deg 0.3 | tee mount.txt
  grep -q "^warning    yaw: one sigma is .* above the limit of 0.30" mount.txt || fail "calibrate_mount does not warn of a weak yaw"
  grep -q "straight leg of [0-9]* m" mount.txt || fail "calibrate_mount does not say what helps"
  refused 1 "stood 0 times" "$bin/calibrate_mount" --site "$source/test/ros/site.yaml" --bag drive.bag
  refused 1 "floor-sigma-deg" "$bin/calibrate_mount" --site "$source/test/ros/site.yaml" --bag mount.bag --floor-sigma-deg 0
fi
for tool in $tools; do
  "$bin/$tool" --help | grep -q "Examples:" || fail "$tool --help has no examples"
done
if [ -x "$bin/bridge_tail" ]; then  # WITH_WMS
  "$bin/bridge_tail" --help | grep -q "Examples:" || fail "bridge_tail --help has no examples"
  refused 2 "--help" "$bin/bridge_tail" --brokr tcp://localhost:1
  # It says so and goes on.
  "$bin/bridge_tail" --broker tcp://127.0.0.1:1 --count 1 >out.txt 2>&1 &
  tail=$!
  for ((i = 0; i < 600; ++i)); do
    grep -q "not connected" out.txt && break
    sleep 0.1
  done
  kill "$tail" || fail "bridge_tail ended by itself"
  wait "$tail" || fail "bridge_tail did not end well"
  grep -q "not connected" out.txt || fail "bridge_tail does not say that it is not connected"
fi
echo "all tools do as they say"

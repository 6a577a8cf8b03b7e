# Tables of docs/accuracy.md from reports of `whit cost --json` (tools/accuracy).

def digits($n): . * pow(10; $n) | round / pow(10; $n) | tostring
    | if contains("e") then . else (split(".") | .[0] + "." + ((.[1] // "") + "0000")[:$n]) end;
def ratio: .price[.clock].ratio.median;
def time: if .knob == "usual" then "1" else (ratio | digits(2)) + (if .price.verdict == 0 then " =" else "" end) end;
def line: "| " + join(" | ") + " |";
def head($scenes): ([""] + $scenes | line), (["---"] + ($scenes | map("---:")) | line);
def settings: map(.rows[] | [.knob, .setting]) | reduce .[] as $s ([]; if index([$s]) then . else . + [$s] end);
def cell($name; f): (.clock as $clock | .rows[] | select([.knob, .setting] == $name and .measured)
    | .clock = $clock | f) // "";
def table($reports; $names; f):
    ($names[] as $name | [($name | join(" ") | rtrimstr(" ")), ($reports[] | [cell($name; f)] | .[0] // "")] | line);
def inexact: .aimed_rays | "\(.wrong), \(.leaks), \(.misses + .false_hits + .other_ids)";

[inputs] as $reports
| ($scenes | split(" ")) as $scenes
| [$reports | settings[]] as $names
| "## The rows", "",
  "    whit cost scenes/SCENE.json \($options)", "",
  "On \($day), on \($reports[0].device) (\($reports[0].driver)), clock: \($reports[0].clock). Errors are against the "
  + "reference in double. Times of the usual picture, in ms, and relative to itself:", "",
  head($scenes), (["ms"] + ($reports | map(.rows[0][.clock + "_ms"] | round | tostring)) | line),
  (["beside itself"] + ($reports | map(.rows[0].price[.clock].ratio | "\(.low | digits(2)) to \(.high | digits(2))")) | line),
  (["judged at"] + ($reports | map("\(.judged_width) x \(.judged_height)")) | line),
  (["samples of the reference"] + ($reports | map(.reference.samples | tostring)) | line), "",
  "Time relative to the usual picture (`=`: not distinguishable from it), and FLIP:", "", head($scenes),
  table($reports; $names; "\(time), \(.error.flip | digits(4))"), "",
  "RMSE against a reference with one sample (`alone`):", "", head($scenes),
  table($reports; $names | map(select(.[0] | IN("usual", "numerics", "arithmetic", "instances")));
      .alone.rmse * 1e4 | round / 1e4 | tostring), "",
  "Of 20,000 rays at edges and vertices, against exact arithmetic: wrong hits, leaks, differences within the error bounds of floats:", "",
  head($scenes),
  table($reports; $names | map(select(.[0] | IN("usual", "numerics", "instances"))); inexact)

#!/bin/sh
# Opens the page of `whit cost` in a browser without a window: its console has no message, and it makes no request.
# Skipped where there is no Chromium.
. "$(dirname "$0")/common.sh"
needs jq
. "$(dirname "$0")/browser.sh"
. "$(dirname "$0")/cost_common.sh"

page=$OUT/cost.html
expect 0 "a page" cost "$CUBE" --size 48x36 --quick --rays 0 --spend 1 --reference-samples 4 --knobs aa,shadows \
    --quiet --html "$page"
look "$page"
check "it is drawn" test -s "$OUT/page.png"
dom "$page"
check "by its script: four crops" test "$(count '<div class="crop"')" -eq 4
check "a point for each setting that the reference can judge" test "$(count '<circle ')" -ge 2
check "a table of the usual settings and for each knob" test "$(count '<table>')" -ge 3
check "of a knob with one setting one time and error, not from where to where" \
    grep -q '<small>x [0-9.]* in time, FLIP [0-9.]*</small>' "$OUT/dom"
check "the sentence" grep -q '<p id="sentence">[A-Z0-9].*\.</p>' "$OUT/dom"
check "options that no line breaks" grep -q '<span class="option">--aa [0-9]*</span>' "$OUT/dom"
check "nothing on the console" test "$(wc -l <"$OUT/console")" -eq 0
check "no request" test "$(wc -l <"$OUT/requests")" -eq 0

sed 's/"option":"[^"]*"/"option":""/g' "$page" >"$OUT/usual.html"
dom "$OUT/usual.html"
check "a choice of the usual settings has a name" grep -q 'chosen within [0-9.]* ms' "$OUT/dom"

clipped "$page"
check "nothing is clipped ($(cat "$OUT/clipped"))" test "$(cat "$OUT/clipped")" = "1280: "
for wide in "table { width: 130% }" "svg text { font-size: 99px }"; do
    sed "s|</style>|$wide</style>|" "$page" >"$OUT/wide.html"
    clipped "$OUT/wide.html"
    check "such is seen: $wide" test "$(wc -c <"$OUT/clipped")" -gt 6
done

# A crop of a picture that is one pixel wide is not as long as the page is wide for each pixel.
sed 's|"crop":{[^}]*}|"crop":{"x":0,"y":0,"width":1,"height":40}|' "$page" >"$OUT/thin.html"
cat >>"$OUT/thin.html" <<'END'
<script>document.body.append(make("p", {id: "long"}, String(document.querySelector(".crop").clientHeight)));</script>
END
dom "$OUT/thin.html"
long=$(sed -n 's|.*<p id="long">\([0-9]*\)</p>.*|\1|p' "$OUT/dom")
check "a thin crop is as long as a window ($long)" test "${long:-0}" -gt 100 -a "${long:-0}" -lt 1000

# The two checks can fail: a picture from elsewhere is reported as forbidden, and as a request where it is allowed.
bad='<body><img src="http://127.0.0.1:9/x.png"/>'
sed "s|<body>|$bad|" "$page" >"$OUT/forbidden.html"
look "$OUT/forbidden.html"
check "a picture from elsewhere is forbidden" grep -q "Content Security Policy" "$OUT/console"
check "and not asked for" test "$(wc -l <"$OUT/requests")" -eq 0
sed "s|<body>|$bad|; s|http-equiv|name|" "$page" >"$OUT/asking.html"
look "$OUT/asking.html"
check "such requests are seen" grep -q "127.0.0.1:9" "$OUT/requests"
finish

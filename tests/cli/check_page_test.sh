#!/bin/sh
# The page of whit check, and thumbnails: their contents and sizes. Where Chromium is installed, it shows the page that
# the script draws.
. "$(dirname "$0")/common.sh"
needs jq
HERE=$(cd "$(dirname "$0")" && pwd)
cd "$OUT" || exit 1
cp "$SCENES/cube.json" .
printf 'kept cube.json --size 128x96\nlost cube.json --size 64x48\nfine cube.json --size 64x48 --view visits\n' >looks.whit

# report FILE: prints the JSON of a page.
report() {
    sed -n 's|.*<script id="report" type="application/json">\(.*\)</script>.*|\1|p' "$1"
}

refuse 2 "thumbnails alone" "are of pictures that are drawn for --accept" check looks.whit --thumbnails
refuse 2 "a page that cannot be written" "nowhere/p.html" check looks.whit --report nowhere/p.html
expect 0 "accept" check looks.whit --accept all --thumbnails
check "a thumbnail of each case" test "$(echo looks.thumbnails/*.png)" = \
    "looks.thumbnails/fine.png looks.thumbnails/kept.png looks.thumbnails/lost.png"
for file in looks.thumbnails/*; do
    check "$file: at most 4096 bytes" test "$(wc -c <"$file")" -le 4096
done
printf 'wide cube.json --size 960x9\nhigh cube.json --size 3x400\n' >narrow.whit
expect 0 "narrow pictures" check narrow.whit --accept all --thumbnails
sed 's/"intensity": 24/"intensity": 12/' cube.json >dim.json
sed -i 's/cube/dim/' narrow.whit
expect 1 "narrow pictures that differ" check narrow.whit --report narrow.html
check "are shown as they were" jq -e '[.cases[] | select(.before and .difference)] | length == 2' <<END
$(report narrow.html)
END
expect 0 "all as it was" check looks.whit --report fine.html
check "nothing to compare" test "$(report fine.html | jq '[.cases[] | select(.before)] | length')" -eq 0
check "three pictures" test "$(report fine.html | jq '[.cases[] | select(.after)] | length')" -eq 3

check "what is fine takes little room" test "$(report fine.html | jq '[.cases[] | select(.command or .is or .was)] | length')" -eq 0
rm looks.thumbnails/lost.png
sed -i 's/"intensity": 24/"intensity": 12/; s/"name": "cube"/"name": "<\/script>"/' cube.json
expect 1 "a dimmer light" check looks.whit --report page.html
report page.html >page.json
cp page.html seen.html
check "what was, what is, and what differs" jq -e '.cases[0] | .verdict == "differs" and .flip_mean > 0.01 and
    .flip_mean < 1 and ([.before, .after, .difference, .flip] | all(startswith("data:image/png;base64,")))' page.json
check "without a thumbnail what is alone" jq -e '.cases[1] | .verdict == "differs" and .before == null and .after' page.json
check "costs are as they were" jq -e '.cases[2].verdict == "same" and .cases[2].after' page.json
check "less than 1 MB" test "$(wc -c <page.html)" -lt 200000
check "no request (SVG is a name)" test "$(grep 'https*://' page.html | grep -vc '"http://www.w3.org/2000/svg"')" -eq 0
echo damaged >looks.thumbnails/kept.png
expect 1 "a damaged thumbnail" check looks.whit --report page.html
check "is a warning" grep -q "^whit: warning: looks.thumbnails/kept.png: cannot be read" stderr
: >looks.thumbnails/lost.png
expect 0 "another picture without a thumbnail" check looks.whit --accept lost --reason dimmer
check "has none, as the old one is not its" test ! -e looks.thumbnails/lost.png
rm narrow.golden && mv narrow.thumbnails thumbnails && touch narrow.thumbnails
expect 2 "thumbnails that cannot be written" check narrow.whit --accept all --thumbnails
check "each is told, and that the cases are accepted" test "$(grep -c "narrow.thumbnails/.*: cannot write" stderr) $(tail -n 1 stdout)" = \
    "2 2 cases, 2 accepted"
printf 'lost cube.json --size 64x48\n' >looks.whit
expect 0 "prune" check looks.whit --prune
check "drops thumbnails" test "$(echo looks.thumbnails/*)" = "looks.thumbnails/*"

if command -v chromium >/dev/null || command -v chromium-browser >/dev/null; then
    . "$HERE/browser.sh"
    dom "$OUT/seen.html"
    check "by its script: two articles" test "$(count '<article>')" -eq 2
    check "and six pictures" test "$(count '<img ')" -eq 6
    check "with the cause, and the command" test "$(count '<li>input changed: light ')" -eq 2 -a \
        "$(count '<pre>whit render cube.json --size ')" -eq 2
    check "nothing stands for what is not there but what was not kept" test "$(count 'class="none"')" -eq 1
    look "$OUT/seen.html"
    check "nothing on the console" test "$(wc -l <"$OUT/console")" -eq 0
    check "nothing asked for" test "$(wc -l <"$OUT/requests")" -eq 0
    mv cube.json 'a\xb.json'
    printf '%s\n' "a 'a\\xb.json' --size 40x30" >backslash.whit
    expect 4 "a backslash before an x" check backslash.whit --report backslash.html
    dom "$OUT/backslash.html"
    check "is in the command as the shell needs it" test "$(count '<pre>whit render .a\\xb.json')" -eq 1
else
    echo "SKIPPED part: no Chromium"
fi
finish

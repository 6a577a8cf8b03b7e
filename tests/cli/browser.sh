# Tests of pages source this file after common.sh: it runs a browser without a window. Skips where there is no Chromium.
browser=$(command -v chromium || command -v chromium-browser || command -v google-chrome) || browser=
if [ -z "$browser" ]; then
    echo "SKIPPED: no Chromium"
    exit 77
fi

# look PAGE: opens the page, and leaves its messages in $OUT/console and its requests in $OUT/requests. Requests of the
# browser itself find no host and do not count.
look() {
    timeout 50 "$browser" --headless --no-sandbox --disable-gpu --no-first-run \
        --disable-background-networking --host-resolver-rules='MAP * ~NOTFOUND' \
        --user-data-dir="$OUT/browser" --enable-logging=stderr --log-net-log="$OUT/net.json" \
        --window-size=1280,3000 --screenshot="$OUT/page.png" "file://$1" >"$OUT/log" 2>&1 ||
        echo "FAILED  the browser: $(tail -n 1 "$OUT/log")"
    grep CONSOLE "$OUT/log" >"$OUT/console"
    jq -r '(.constants.logSourceType | to_entries | map({(.value | tostring): .key}) | add) as $kinds |
        .events[] | select($kinds[.source.type | tostring] == "URL_REQUEST") | .params |
        select(.url and (.initiator // "not an origin") != "not an origin") | .url' \
        "$OUT/net.json" >"$OUT/requests"
}

# dom PAGE: writes the page as its script has made it to $OUT/dom.
dom() {
    timeout 50 "$browser" --headless --no-sandbox --disable-gpu --user-data-dir="$OUT/browser" --window-size=1280,3000 \
        --dump-dom "file://$1" >"$OUT/dom" 2>/dev/null
}
# count PATTERN: prints the number of matches in $OUT/dom.
count() {
    grep -o "$1" "$OUT/dom" | wc -l
}

# clipped PAGE: writes the elements that do not fit into a window 1280 pixels wide, with all folds open, to
# $OUT/clipped. Crops are cut on purpose and do not count.
clipped() {
    { cat "$1" && cat; } >"$OUT/measured.html" <<'END'
<script>
for (const fold of document.querySelectorAll("details")) fold.open = true;
const isOut = e => {
  const box = e.getBoundingClientRect(), svg = e.closest("svg"), frame = (svg || document.documentElement).getBoundingClientRect();
  return box.left < frame.left - 1 || box.right > frame.right + 1 ||
    (svg ? box.top < frame.top - 1 || box.bottom > frame.bottom + 1
         : e.scrollWidth > e.clientWidth + 1 && e.clientWidth > 0 && getComputedStyle(e).display !== "inline");
};
const out = [...document.body.querySelectorAll("*")].filter(e => !e.closest(".crop") && !e.matches("script, title") && isOut(e));
document.body.append(Object.assign(document.createElement("p"), {id: "measured",
  textContent: `${innerWidth}: ${out.map(e => e.outerHTML.slice(0, 60)).join(", ")}`}));
</script>
END
    dom "$OUT/measured.html"
    sed -n 's|.*<p id="measured">\(.*\)</p>.*|\1|p' "$OUT/dom" >"$OUT/clipped"
}

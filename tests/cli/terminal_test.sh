#!/bin/sh
# Names and words of files may have characters that control a terminal, are invisible or are not UTF-8. Wherever whit
# prints them, they are visible and control nothing; JSON keeps all of them. No device is opened.
. "$(dirname "$0")/common.sh"
needs jq
needs iconv
VK_DRIVER_FILES=/nonexistent
VK_ICD_FILENAMES=/nonexistent
export VK_DRIVER_FILES VK_ICD_FILENAMES

# The characters: a title of the window, colours, a C1 control in UTF-8 and as one byte, right-to-left text, zero width,
# a tag, a line separator; bytes that are no character, half a character, an overlong slash, a surrogate.
GOOD=$(printf 'x\033]0;t\007\033[31m\302\2332J\342\200\256\342\200\213\363\240\201\201\342\200\250\177')
EVIL=$(printf '%s\233\377\342\202-\300\257-\355\240\200' "$GOOD")
SHOWN='x\u001b]0;t\u0007\u001b[31m\u009b2J\u202e\u200b\udb40\udc41\u2028\u007f'
SHOWN_EVIL="$SHOWN"'\x9b\xff\xe2\x82-\xc0\xaf-\xed\xa0\x80'
mkdir "$OUT/files"
cd "$OUT/files" || exit 1

# is_plain FILE: the file has only printable UTF-8 and line ends.
is_plain() {
    if LC_ALL=C grep -q "$(printf '[\001-\011\013-\037\177]')" "$1" ||
        LC_ALL=C grep -q "$(printf '\302[\200-\237\255]')" "$1" ||
        LC_ALL=C grep -q "$(printf '\342\200[\213-\217\250-\256]')" "$1" ||
        LC_ALL=C grep -q "$(printf '\342\201[\240-\257]\\|\363\240')" "$1"; then
        return 1
    fi
    iconv -f UTF-8 -t UTF-8 "$1" >/dev/null 2>&1
}
for byte in '\033' '\177' '\233' '\302\233' '\342\200\256' '\342\201\246' '\363\240\201\201' '\300\257'; do
    # shellcheck disable=SC2059
    printf "a${byte}b\n" >probe
    check "the check finds $byte" test "$(is_plain probe || echo no)" = no
done
printf 'a\303\244\342\202\254b\n' >probe
check "the check leaves text alone" is_plain probe

# says CODE WHAT TEXT ARGUMENT...: whit exits with CODE; its output is plain and has TEXT.
says() {
    code=$1
    title=$2
    text=$3
    shift 3
    expect "$code" "$title" "$@"
    check "$title: standard output is plain" is_plain "$OUT/stdout"
    check "$title: standard error is plain" is_plain "$OUT/stderr"
    check "$title: shows what it is" grep -qF -- "$text" "$OUT/stdout" "$OUT/stderr"
}

# ---- An OBJ: its name, its library, materials, keywords, pictures ----

printf 'mtllib %s.mtl\no mesh-%s\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red-%s\nf 1 2 3\n' \
    "$EVIL" "$EVIL" "$EVIL" >"$EVIL.obj"
{
    printf 'newmtl red-%s\nKd 1 0 0\nillum 99\nmap_Ks nowhere-%s.png\n' "$EVIL" "$EVIL"
    printf 'key-%s 1\n' "$EVIL"
} >"$EVIL.mtl"
says 0 "an OBJ" "red-$SHOWN_EVIL" scene --all "$EVIL.obj"
check "its name" grep -qF "$SHOWN_EVIL.obj" "$OUT/stdout"
check "what its notes quote" grep -qF "nowhere-x\\u001b]0;t" "$OUT/stdout"
check "and a keyword" grep -qF "key-x\\u001b]0;t" "$OUT/stdout"
says 0 "a trace" "$SHOWN_EVIL.obj" bvh "$EVIL.obj" --no-trace --runs 1 --threads 1 --build median

# ---- JSON loses nothing ----

says 0 "the JSON" '' scene --all --json "$EVIL.obj"
# The original bytes are restored as docs/cli.md describes.
jq -j '.materials[].name' "$OUT/stdout" |
    sed 's/%/%%/g; s/\\/\\\\/g; s/\\\\x\([0-9a-f][0-9a-f]\)/\\x\1/g' >format
check "a name out of JSON is what it was" test "$(env printf "$(cat format)")" = "red-$EVIL"
cat >names.json <<JSON
{ "materials": { "$(printf %s "$SHOWN")": {}, "a\\\\xff": {}, "ä €": {} },
  "objects": [ { "name": "o", "shape": "box", "size": 1, "material": "a\\\\xff" } ] }
JSON
says 0 "names in JSON" '' scene --all --json names.json
check "control characters come back" \
    jq -e --arg good "$GOOD" '[.materials[].name] | index($good)' "$OUT/stdout"
check "what looks like a byte is none" jq -e '[.materials[].name] | index("a\\x5cxff")' "$OUT/stdout"
check "other text is as it was" grep -qF "ä €" "$OUT/stdout"

# ---- Broken files ----

printf '{ "objects": [ { "shape": "%s" } ] }' "$SHOWN" >word.json
says 2 "a word of JSON" "$SHOWN" scene word.json
printf '{ "%s": 1 }' "$SHOWN" >key.json
says 2 "a key of JSON" "$SHOWN" render key.json -o x.png
printf '{ "a": %s }' "$EVIL" >token.json
says 2 "a token of JSON" token.json scene token.json
printf '{ "asset": { "version": "%s" } }' "$SHOWN" >version.gltf
says 2 "glTF" "$SHOWN" scene version.gltf
printf '{ "asset": { "version": "2.0" }, "extensionsRequired": [ "%s" ] }' "$SHOWN" >"$EVIL.gltf"
says 2 "an extension" "$SHOWN_EVIL.gltf" scene "$EVIL.gltf"
printf 'ply\nformat %s 1.0\nelement vertex %s\nend_header\n' "$EVIL" "$EVIL" >"$EVIL.ply"
says 2 "PLY" "$SHOWN_EVIL.ply" scene "$EVIL.ply"
printf 'solid %s\nfacet normal %s 0 0\nouter loop\nvertex %s 1 1\n' "$EVIL" "$EVIL" "$EVIL" >"$EVIL.stl"
says 2 "STL" "$SHOWN_EVIL.stl" scene "$EVIL.stl"
printf 'v %s\nv 0 0 0\nv 1 0 0\nf 1 2 %s\n' "$EVIL" "$EVIL" >bad.obj
says 2 "numbers of an OBJ" bad.obj scene bad.obj

# ---- At most 40 characters of a file ----

LONG=$(printf '%060d' 0 | tr 0 k)
SHORT=$(printf '%040d' 0 | tr 0 k)...
for file in "word.json:{ \"objects\": [ { \"shape\": \"$LONG\" } ] }" "key.json:{ \"$LONG\": 1 }" \
    "version.gltf:{ \"asset\": { \"version\": \"$LONG\" } }" \
    "need.gltf:{ \"asset\": { \"version\": \"2.0\" }, \"extensionsRequired\": [ \"$LONG\" ] }"; do
    printf %s "${file#*:}" >"${file%%:*}"
    says 2 "a long word, ${file%%:*}" "$SHORT" scene "${file%%:*}"
    check "and no more of it" test "$(grep -c "$LONG" "$OUT/stderr")" -eq 0
done
printf 'solid s\nfacet normal 0 0 1\nouter loop\nvertex %s 1 1\n' "$LONG" >long.stl
says 2 "a long word for the importer" "\"${SHORT%...}\"" scene long.stl

# ---- Names on the command line, pictures, settings ----

says 2 "no such file" "$SHOWN_EVIL" scene "$EVIL"
says 2 "no such option" "$SHOWN_EVIL" scene --"$EVIL" x
says 2 "no such camera" "$SHOWN_EVIL" render "$CUBE" -o x.png --camera "$EVIL"
says 2 "no folder for it" "$SHOWN_EVIL" render "$CUBE" -o "$EVIL/x.png"
printf 'PF\n1 1\n-1.0\n\0\0\0\0\0\0\0\0\0\0\0\0' >"$EVIL.pfm"
says 0 "pictures" "$SHOWN_EVIL.pfm" compare "$EVIL.pfm" "$EVIL.pfm"
says 2 "a scene for a picture" "$SHOWN_EVIL.ply" compare "$EVIL.ply" "$EVIL.pfm"
# In files of settings whit writes control characters as escapes of the shell.
if "$WHIT" view --help >/dev/null 2>&1; then
    printf '%s\n' "--build 'a'\$'\\x1b\\x5b'\\0" >x.view
    says 2 "settings" 'x.view:1: --build `a\u001b[0`' view "$CUBE" --state x.view
    printf '%s\n' "--build $LONG" >x.view
    says 2 "a long word of settings" "x.view:1: --build \`$SHORT\`" view "$CUBE" --state x.view
    printf '%s\n' "$LONG" >x.replay
    says 2 "a long line of a replay" "x.replay:1: \`$SHORT\`" view "$CUBE" --replay x.replay
    for end in '' '\x0' "\\x00'" '\x1'; do
        printf '%s\n' "--build \$'\\x1b$end" >x.view
        says 2 "settings cut at \`$end\`" 'x.view:1: a quote has no end' view "$CUBE" --state x.view
    done
fi
finish

#!/bin/sh
# Every kernel, as it is embedded and with its specialization constants set, passes spirv-val. Every
# float operation of it is rounded as it is written: marked NoContraction, and no fma(), which Vulkan
# lets a driver round once or twice. No kernel has numbers of 64 bits, but for integers of rows with
# SPEC_WIDE_ROWS; without it, none and no capability for them. With constants filled in, kernels
# are checked for none, all, and all but one of each, of which a short run takes an eighth, others with each commit
# (WHIT_TEST_OFFSET); with `all` for all of these, and for each alone as well.
# In kernels made portable nothing is left that Vulkan leaves to drivers; with all constants set, a quarter of them
# is validated with each commit.
#     spirv_test.sh KERNEL_DUMP [all]
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
dump=$1
all_too=${2:-}
"$dump" "$folder" > "$folder/constants"
validations=0
turn=${WHIT_TEST_OFFSET:-0}

validate() {
    spirv-val --target-env vulkan1.2 "$1" || { echo "spirv-val refuses $2"; exit 1; }
    validations=$((validations + 1))
}

# rounded_as_written KERNEL OPERATIONS: that there are at least
rounded_as_written() {
    spirv-dis --raw-id "$1" | awk -v kernel="$1" -v least="$2" '
        $1 == "OpDecorate" && $3 == "NoContraction" { marked[$2] = 1 }
        $3 ~ /^Op(F(Negate|Add|Sub|Mul|Div|Rem|Mod)|VectorTimesScalar|VectorTimesMatrix|Dot|Matrix.*|OuterProduct)$/ {
            operations++
            if (!marked[$1]) { print kernel ": not NoContraction: " $0; bad++ }
        }
        $3 == "OpExtInst" && $6 == "Fma" { print kernel ": " $0; bad++ }
        $3 == "OpTypeFloat" && $4 == 64 {
            print kernel ": 64-bit numbers, which a device may lack: " $0
            bad++
        }
        END {
            printf "%s: %d of %d float operations may be contracted\n", kernel, bad, operations
            exit bad > 0 || operations < least
        }' > "$folder/operations" || { head -5 "$folder/operations"
        echo "FAILED  $(tail -n 1 "$folder/operations")"; exit 1; }
    tail -n 1 "$folder/operations"
}

# evaluate KERNEL "id:value id:value ..." [unvalidated]: constants filled in, what they switch off removed, as
# drivers get it.
evaluate() {
    "$dump" "$folder/evaluated" "$(basename "$1" .spv)" "$2" || { echo "$1 with $2 is refused"; exit 1; }
    [ -n "${3:-}" ] || validate "$folder/evaluated" "$1 with $2, evaluated"
    case "$2 " in *" $wide:0 "*) ;; *) return 0 ;; esac
    if spirv-dis --raw-id "$folder/evaluated" | grep -E "Int64|OpTypeInt 64"; then
        echo "FAILED  $1 with $2: integers of 64 bits, which a device may lack"
        exit 1
    fi
}

# What is exact, or rounded correctly, of what GLSL.std.450 has.
exact="RoundEven|Trunc|FAbs|SAbs|SSign|Floor|Ceil|[US]M(in|ax)|[US]Clamp|Step|FindILsb|Find[US]Msb"

# portable KERNEL "id:value ..." [unvalidated]: evaluated as above.
portable() {
    evaluate "$@"
    spirv-dis --raw-id "$folder/evaluated" | awk -v exact="^($exact)$" '
        $3 == "OpExtInst" && $6 !~ exact { print $6; bad++ }
        $3 ~ /^Op(F(Div|Rem|Mod|Convert)|Dot|Is(Nan|Inf)|(Vector|Matrix)TimesMatrix|MatrixTimesVector)$/ {
            print $3
            bad++
        }
        END { exit bad > 0 }' > "$folder/left" || {
        echo "FAILED  $1 with $2: drivers decide $(sort -u "$folder/left" | tr '\n' ' ')"; exit 1; }
}

# Sizes are none: there is at least one of each.
sizes="SPEC_GROUP_SIZE SPEC_PACKET_RAYS SPEC_LIT_RAYS SPEC_CLASSES SPEC_SEGMENTS"
switches=$(awk -v sizes=" $sizes " '$3 <= 1 && !index(sizes, " " $2 " ") { print $1 }' "$folder/constants")
wide=$(awk '$2 == "SPEC_WIDE_ROWS" { print $1 }' "$folder/constants")
[ -n "$switches" ] && [ -n "$wide" ]
none=
all=
for id in $switches; do
    none="$none $id:0"
    all="$all $id:1"
done
for kernel in "$folder"/*.spv; do
    validate "$kernel" "$kernel"
    case $kernel in
    */portable_resolve.spv | */resolve.spv) rounded_as_written "$kernel" 10 ;;
    *) rounded_as_written "$kernel" 100 ;;
    esac
    case $kernel in
    */portable_*)
        portable "$kernel" "0:64 2:1$none"
        turn=$((turn + 1)) # with all of it spirv-val takes 3 s
        unvalidated=unvalidated
        [ -z "$all_too" ] && [ $((turn % 4)) -ne 0 ] || unvalidated=
        portable "$kernel" "0:64 2:64$all" $unvalidated
        continue ;;
    esac
    evaluate "$kernel" "0:64 2:1$none"
    evaluate "$kernel" "0:64 2:64$all"
    used=$(spirv-dis --raw-id "$kernel" | awk '$1 == "OpDecorate" && $3 == "SpecId" { print $4 }')
    for id in $switches; do
        echo "$used" | grep -qx "$id" || continue
        turn=$((turn + 1))
        [ -n "$all_too" ] || [ $((turn % 8)) -eq 0 ] || continue
        less=$(echo "0:64 2:24$all" | sed "s/ $id:1/ $id:0/")
        more=$(echo "0:64 2:24$none" | sed "s/ $id:0/ $id:1/")
        evaluate "$kernel" "$less"
        [ -z "$all_too" ] || evaluate "$kernel" "$more"
    done
done
echo "$validations modules are valid"
[ "$validations" -gt ${all_too:+2}50 ]

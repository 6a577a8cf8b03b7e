#!/bin/sh
# --budget-ms and --max-error in the window: settings are chosen while the user goes on with the picture.
. "$(dirname "$0")/common.sh"
. "$(dirname "$0")/view_common.sh"
mkdir "$OUT/work"
cd "$OUT/work" || exit 1
BALLS=$SCENES/balls.json
SIZE=24x16 # whose many pictures are quickly measured

# wished SCENE EVENT SCENE TEXT OPTION...: EVENT comes while the costs of the first scene are being measured; then the
# choice is that for the second scene, and its stage is TEXT.
wished() {
    scene=$1
    event=$2
    measured=$3
    text=$4
    shift 4
    play "$*" "$scene" --size $SIZE --spend 0.1 --fresh "$@" <<END
first! picture | wish.predicted_ms = 0
chosen! until wish.stage = measures, $event, press T, still | scene = $measured | wish.stage = $text
    | keys.traversal = sign | frame.whole = true | frame.drawn_words is words of chosen
elsewhere: press 1 | wish.stage = $text
left: press Equal
END
}

# chose NAME: the options in the text of the choice are the settings of the window.
chose() {
    text=$(value "$1" wish.text)
    [ "$text" = "what is usual" ] && text=
    check "what is told is what is set ($text)" \
        test "$(value "$1" words | sed 's/ --traversal sign//')" = "--size $SIZE${text:+ $text}"
}

if part 0 2; then
    # A scene that is dropped while another one is measured ends that measurement, and is measured itself.
    wished "$CUBE" "drop $BALLS" "$BALLS" chosen --max-error 0.9
    chose chosen
    error=$(value chosen wish.predicted_error)
    check "one sample or less will do ($error)" holds "$error > 0 && $error <= 0.81"
    check "its picture was timed" holds "$(value chosen wish.took_ms) > 0"
    renders chosen -o rendered.pfm
fi

if part 1 2; then
    wished "$CUBE" "" "$CUBE" chosen --budget-ms 1e6
    chose chosen
    case $(value chosen words) in *--aa*) more=yes ;; *) more=no ;; esac
    check "time enough gives more samples ($(value chosen words))" test $more = yes
    differs words chosen left
fi

if part 0 2; then
    wished "$CUBE" "" "$CUBE" "no choice" --budget-ms 0.001
    is chosen wish.text "no setting takes so little here"
    is chosen words "--size $SIZE --traversal sign"
fi

if part 1 2; then
    # If the picture takes far longer than predicted, whit chooses again; the choice stays where no other comes nearer.
    patient=$WHIT
    WHIT=$3
    export WHIT_TEST_SLOW=told
    wished "$CUBE" "" "$CUBE" chosen --budget-ms 1e6
    unset WHIT_TEST_SLOW
    WHIT=$patient
    is chosen words "--size $SIZE --aa 64 --traversal sign"
    is chosen wish.took_ms 70000000 # one sample, and six times as many as there were
    is chosen wish.text "no setting takes so little here"
fi

if part 1 2; then
    # The next run chooses by the same kept figures, so that the same time gives the same choice.
    chosen() {
        play "kept, $*" "$CUBE" --size $SIZE --spend 0.1 "$@" <<END
first: until wish.stage = chosen | wish.stage = chosen
END
        choice="$(value first words) $(printf %.9g "$(value first wish.predicted_error)")"
    }
    chosen --fresh --budget-ms 1e6
    is first wish.known false
    before=$choice
    chosen --budget-ms 1e6
    is first wish.known true
    check "the same choice ($choice; $before)" test "$choice" = "$before"
    chosen --budget-ms 1e5 # by these figures, but not chosen for as yet
    is first wish.known false
fi

refuse 2 "chosen and given" "chooses --aa" view "$CUBE" --budget-ms 10 --aa 4 --frames 1
refuse 2 "two wishes" "one of them" view "$CUBE" --budget-ms 10 --max-error 1 --frames 1
finish

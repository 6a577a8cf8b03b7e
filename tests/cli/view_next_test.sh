#!/bin/sh
# The very next picture shows an action of the user. The figures of a view are right (with `large` as the third argument
# also for a scene with instances).
# shellcheck disable=SC2086 # Options are split where they are used.
. "$(dirname "$0")/common.sh"
. "$(dirname "$0")/view_common.sh"
SMALL="--size 96x64 --fps-goal 0.1" # whole pictures also while something moves

# next NAME BEFORE: the picture of the state has all settings that were asked for, and is the next one after that of
# BEFORE.
next() {
    check "at $1: the next picture ($(value "$2" frame.number), $(value "$1" frame.first))" \
        test "$(value "$1" frame.first)" -eq $(($(value "$2" frame.number) + 1))
    is "$1" frame.drawn_words "$(value "$1" words)"
}

# ---- Keys ----

if part 0 2; then
    KEYS="T K O Minus Equal Y B V T ] 2 Home Period"
    {
        n=0
        for key in $KEYS; do
            printf 'still\nstate before%d\npress %s\npicture\nstate after%d\n' $n "$key" $n
            n=$((n + 1))
        done
        printf 'still\nstate before%d\n' $n
    } >"$OUT/keys"
    play "keys" "$SCENES/spin.json" $SMALL <"$OUT/keys"
    n=0
    for key in $KEYS; do
        differs words before$n after$n
        next after$n before$n
        case $key in
        2 | Home | Period) # the same kernel: a whole picture at once
            differs frame.ids before$n after$n
            same frame.ids after$n before$((n + 1))
            ;;
        esac
        n=$((n + 1))
    done
fi

# ---- A drag ----

if part 1 2; then
    # drag EVENT: prints a replay of a drag with EVENT after each move.
    drag() {
        printf 'still\nstate m0\nmove 30 30\nbutton left down\n'
        for n in 1 2 3 4 5 6; do
            printf 'move %d %d\n%s\nstate m%d\n' $((30 + 4 * n)) $((30 + n)) "$1" $n
        done
        printf 'button left up\n'
    }
    drag picture >"$OUT/drag"
    play "a drag" "$SCENES/34k.json" $SMALL <"$OUT/drag"
    for n in 1 2 3 4 5 6; do
        next m$n m$((n - 1))
        differs words m$((n - 1)) m$n
        value m$n frame.ids >"$OUT/moving.$n"
        value m$n words >"$OUT/words.$n"
    done
    drag still >"$OUT/drag"
    play "the same drag, still each time" "$SCENES/34k.json" $SMALL <"$OUT/drag"
    for n in 1 2 3 4 5 6; do
        is m$n words "$(cat "$OUT/words.$n")"
        is m$n frame.ids "$(cat "$OUT/moving.$n")"
    done

    # If a picture is being drawn or was just shown, the one after it shows the action. `wait` gives the first request
    # time to reach the engine.
    play "a picture on its way" "$SCENES/34k.json" $SMALL <<END
before:
after: move 30 30, button left down, move 40 32, wait 1, move 50 36 | frame.drawn_words is words of after
button left up
END
    check "two pictures later at most" test "$(value after frame.number)" -le $(($(value before frame.number) + 2))
fi

# ---- Visits of a ray ----

if part 0 2; then
    # Over all pixels the float mirror on the CPU counts as many visits as the kernel, in any order of nodes.
    scenes=34k
    [ "$3" != large ] || scenes="34k swarm"
    for scene in $scenes; do
        play "visits, $scene" "$SCENES/$scene.json" $SMALL <<END
distance: size 64 48 | frame.visits_rays = 3072
counted: press V | frame.view = depth | frame.visits_rays = 3072 | frame.visits as distance
basic: press Shift+T | frame.visits_rays = 3072
twin: press V x5 | frame.view = color | frame.visits_rays = 3072 | frame.visits as basic | frame.visits not as distance
END
        check "$scene: some are visited ($(value distance frame.visits))" \
            holds "$(value distance frame.visits) > 2 && $(value distance frame.visits) < 200"
    done
fi
if part 1 2; then
    play "visits without trees" "$CUBE" $SMALL <<END
no_trees: still, press G, press T | keys.trees = off | frame.visits_rays = 1536 | frame.visits = 1
END
    # In a larger picture the float mirror counts only a part of the pixels.
    play "visits of some" "$SCENES/34k.json" --size 120x80 <<END
twin:
counted: press V | frame.visits_rays = 9600
END
    check "at most 4096 rays ($(value twin frame.visits_rays))" test "$(value twin frame.visits_rays)" -le 4096
    check "within 5 % ($(value twin frame.visits), $(value counted frame.visits))" \
        about "$(value counted frame.visits)" "$(value twin frame.visits)" 0.05
fi
finish

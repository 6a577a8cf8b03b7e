# Prints the 20 tests that took longest, and then the summary at the end of ctest's output again, with its
# count of passed and failed tests as the last line.
/^ *[0-9]+\/[0-9]+ Test +#[0-9]+: / {
    name = $0
    sub(/^ *[0-9]+\/[0-9]+ Test +#[0-9]+: /, "", name)
    sub(/ .*/, "", name)
    taken_s[name] = $(NF - 1)
}

/^[0-9]+% tests passed, / {
    counts = $0
    next
}

counts != "" {
    summary = summary $0 "\n"
}

END {
    for (rank = 1; rank <= 20; ++rank) {
        longest = ""
        for (name in taken_s)
            if (longest == "" || taken_s[name] + 0 > taken_s[longest] + 0)
                longest = name
        if (longest == "")
            break
        if (rank == 1)
            print "Longest entries, in seconds:"
        printf "%8.2f  %s\n", taken_s[longest], longest
        delete taken_s[longest]
    }
    printf "%s\n%s\n", summary, counts
}

# Each function of whit.h that gives a result says in the comment before it which errors that may be:
#     awk -f errors.awk host/whit/*.h
/^\/\*/ { comment = "" }
/^\/\*/, /\*\// { comment = comment $0 " " }
/^typedef|^enum|^struct/ { comment = "" }
/^WHIT_CHECK whit_result whit_/ {
    name = $3
    sub(/\(.*/, "", name)
    ++functions
    if (comment !~ /WHIT_ERROR_|gives what whit_/) {
        print FILENAME ":" FNR ": " name " does not say which errors it gives"
        failed = 1
    }
}
END {
    if (functions < 30) {
        print "only " functions + 0 " functions were found"
        failed = 1
    }
    exit failed
}

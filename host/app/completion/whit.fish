# fish completion for whit, which knows its own words.
function __whit_words
    set -l line (commandline -opc)
    set -l current (commandline -ct)
    if test (count $line) -eq 1
        $line[1] --complete
    else if string match -q -- '-*' $current
        $line[1] --complete $line[2]
    else if string match -q -- '--*' $line[-1]
        $line[1] --complete $line[2] $line[-1]
    end
end
complete -c whit -a '(__whit_words)'

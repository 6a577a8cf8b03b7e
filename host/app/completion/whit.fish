# fish completion for whit, which knows its own words.
function __whit_values # of the option in front of the current word
    set -l line (commandline -opc)
    string match -q -- '--*' $line[-1]; and $line[1] --complete $line[2] $line[-1] 2>/dev/null
end
function __whit_words
    set -l line (commandline -opc)
    if test (count $line) -eq 1
        $line[1] --complete
    else if string match -q -- '-*' (commandline -ct)
        $line[1] --complete $line[2]
    end
end
complete -c whit -n 'string length -q -- (__whit_values)' -f -a '(__whit_values)'
complete -c whit -n 'not string length -q -- (__whit_values)' -a '(__whit_words)'

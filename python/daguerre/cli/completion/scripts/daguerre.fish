# Completion of daguerre for fish; `daguerre completion fish` prints it.

function __daguerre_complete
    set -l words (commandline -opc)
    set -l program $words[1]
    type -q -- $program; or set program daguerre
    command $program __complete fish $words[2..-1] (commandline -ct) 2>/dev/null </dev/null
end

complete -c daguerre -f -a '(__daguerre_complete)'

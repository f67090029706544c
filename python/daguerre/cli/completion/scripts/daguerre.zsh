#compdef daguerre
# Completion of daguerre for zsh; `daguerre completion zsh` prints it.

_daguerre() {
    local program=${~words[1]}
    (( $+commands[$program] )) || [[ -x $program ]] || program=daguerre
    local -a answer whole begun
    answer=("${(@f)$(command $program __complete zsh "${(@Q)words[2,CURRENT-1]}" "${(Q)PREFIX}" \
        2>/dev/null </dev/null)}")
    (( $#answer > 1 )) || return 1
    compset -p $answer[1]
    whole=(${answer[3,-1]:#*[=:]:*})
    begun=(${(M)answer[3,-1]:#*[=:]:*})
    local result=1
    (( $#whole )) && _describe -t values value whole && result=0
    (( $#begun )) && _describe -t values value begun -S '' && result=0
    case $answer[2] in
        '') ;;
        /) _files -/ && result=0 ;;
        *) _files -g "$answer[2]" && result=0 ;;
    esac
    return result
}

if [[ $funcstack[1] == _daguerre ]]; then
    _daguerre "$@"
else
    (( $+functions[compdef] )) || { autoload -Uz compinit && compinit -i -D }
    compdef _daguerre daguerre
fi

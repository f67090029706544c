# Completion of daguerre for bash; `daguerre completion bash` prints it.

_daguerre() {
    COMPREPLY=()
    ((BASH_VERSINFO[0] >= 4)) || return 0
    local program=${COMP_WORDS[0]/#\~/$HOME}
    type -P -- "$program" >/dev/null || program=daguerre
    local -a answer=()
    mapfile -t answer < <("$program" __complete bash "$COMP_WORDBREAKS" "${COMP_LINE:0:COMP_POINT}" \
        2>/dev/null </dev/null)
    # shellcheck disable=SC2086 # options are words
    [[ -z ${answer[0]} ]] || compopt ${answer[0]} 2>/dev/null
    COMPREPLY=("${answer[@]:1}")
}

complete -F _daguerre daguerre

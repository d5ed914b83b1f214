# Completion of vmech in bash. Install it as share/bash-completion/completions/vmech, or
#   eval "$(vmech completion bash)"
# Commands, options and choices are those of the help of the vmech that is called.

_vmech_commands() {
  "$1" --help 2>/dev/null | sed -n '/^Subcommands:/,/^$/s/^  \([a-z][a-z-]*\).*/\1/p'
}

_vmech_options() {
  "$1" "$2" --help 2>/dev/null | sed -n '/^Options:/,/^$/s/^  \(-[^ ]*\).*/\1/p' | tr , '\n'
}

# What stands in braces behind an option: its choices.
_vmech_choices() {
  "$1" "$2" --help 2>/dev/null |
    sed -n "s/^  \(-[a-zA-Z],\)\?$3 [^{]*{\([^}]*\)}.*/\2/p" | tr , '\n'
}

_vmech() {
  local vmech=$1 word=$2 before=$3 command=${COMP_WORDS[1]} words
  if ((COMP_CWORD == 1)) || { ((COMP_CWORD == 2)) && [[ $command == help ]]; }; then
    words=$(_vmech_commands "$vmech")
    ((COMP_CWORD == 1)) && words+=$'\n--help\n--version'
  elif [[ $command == completion ]]; then
    words=bash
  elif [[ $word == -* ]]; then
    words=$(_vmech_options "$vmech" "$command")
  elif [[ $before == -* ]]; then
    words=$(_vmech_choices "$vmech" "$command" "$before")
  fi
  COMPREPLY=()
  [[ -n $words ]] && mapfile -t COMPREPLY < <(compgen -W "$words" -- "$word")
}

complete -o default -F _vmech vmech

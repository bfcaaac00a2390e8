// pleuel completion SHELL: completions made from the tables of verbs and flags. They know verbs,
// flags, the words of a choice, *.pleuel, the letters after --only and the parameters after --set
// of the file on the command line.
#include "cli.h"

#include <string.h>

const cli_flag flags_completion[] = {CLI_FLAG_HELP, CLI_FLAG_END};

// Words of all verbs, separated by blanks.
static void print_verbs(void) {
  for (const cli_verb* v = cli_verbs; v->name; v++)
    printf("%s%s", v == cli_verbs ? "" : " ", v->name);
}

static void print_flags(const cli_verb* v) {
  for (const cli_flag* f = v->flags; f->name; f++) {
    printf("%s--%s", f == v->flags ? "" : " ", f->name);
    if (f->letter) printf(" -%c", f->letter);
  }
}

static void print_choice(const char* words) {
  for (const char* c = words; *c; c++) putchar(*c == '|' ? ' ' : *c);
}

// Has an earlier verb a flag of this name? Choices are the same everywhere, so one line serves all.
static bool seen_before(const cli_verb* verb, const cli_flag* flag) {
  for (const cli_verb* v = cli_verbs; v->name; v++) {
    for (const cli_flag* f = v->flags; f->name; f++) {
      if (v == verb && f == flag) return false;
      if (strcmp(f->name, flag->name) == 0 && f->kind == flag->kind) return true;
    }
  }
  return false;
}

static void bash(void) {
  puts(
      "# bash completion for pleuel; made by `pleuel completion bash`\n"
      "_pleuel_file() { local w; for w in \"${COMP_WORDS[@]}\"; do [[ $w == *.pleuel && -f $w ]] "
      "&& { echo \"$w\"; return; }; done; }\n"
      "_pleuel_letters() { local f; f=$(_pleuel_file); [ -n \"$f\" ] && sed -n 's/^ *ask  "
      "*\\([a-z]\\) *:.*/\\1/p' \"$f\" | sort -u; }\n"
      "_pleuel_params() { local f; f=$(_pleuel_file); [ -n \"$f\" ] && sed -n 's/#.*//; s/^ *param "
      " *//p' \"$f\" | tr ',' '\\n' |"
      " sed -n 's/^ *\\([^ =[]*\\).*/\\1=/p'; }\n"
      "_pleuel() {\n"
      "  local cur=${COMP_WORDS[COMP_CWORD]} prev=${COMP_WORDS[COMP_CWORD-1]} words=\n"
      "  COMPREPLY=()\n"
      "  case $prev in\n"
      "    --only) words=$(_pleuel_letters) ;;\n"
      "    --set) compopt -o nospace; words=$(_pleuel_params) ;;");
  for (const cli_verb* v = cli_verbs; v->name; v++) {
    for (const cli_flag* f = v->flags; f->name; f++) {
      if (f->kind != CLI_CHOICE || seen_before(v, f)) continue;
      printf("    --%s) words='", f->name);
      print_choice(f->argument);
      puts("' ;;");
    }
  }
  puts(
      "    explain) words=$(pleuel explain 2>/dev/null | cut -d' ' -f1) ;;\n"
      "    examples|--from) words=$(pleuel examples 2>/dev/null | cut -d' ' -f1) ;;\n"
      "    completion) words='bash zsh fish' ;;\n"
      "    -o|--output) COMPREPLY=($(compgen -f -- \"$cur\")); return ;;\n"
      "  esac\n"
      "  if [ -z \"$words\" ]; then\n"
      "    case $cur in\n"
      "      -*) case ${COMP_WORDS[1]} in");
  for (const cli_verb* v = cli_verbs; v->name; v++) {
    printf("        %s) words='", v->name);
    print_flags(v);
    puts("' ;;");
  }
  printf("        *) words='");
  print_flags(cli_verbs);
  printf(
      "' ;;\n      esac ;;\n"
      "      *) COMPREPLY=($(compgen -f -X '!*.pleuel' -- \"$cur\") $(compgen -d -- \"$cur\"))\n"
      "         [ \"$COMP_CWORD\" = 1 ] && words='");
  print_verbs();
  puts(
      "' ;;\n"
      "    esac\n"
      "  fi\n"
      "  COMPREPLY+=($(compgen -W \"$words\" -- \"$cur\"))\n"
      "}\n"
      "complete -F _pleuel pleuel");
}

// In zsh's descriptions brackets and colons have a meaning.
static void zsh_text(const char* s) {
  for (; *s; s++) {
    if (strchr("[]:", *s)) putchar('\\');
    if (*s == '\'') fputs("'\\''", stdout);
    else putchar(*s);
  }
}

static void zsh(void) {
  puts(
      "#compdef pleuel\n"
      "# zsh completion for pleuel; made by `pleuel completion zsh`\n"
      "_pleuel() {\n"
      "  local -a verbs\n"
      "  verbs=(");
  for (const cli_verb* v = cli_verbs; v->name; v++) {
    printf("    '%s:", v->name);
    zsh_text(v->summary);
    puts("'");
  }
  puts(
      "  )\n"
      "  if (( CURRENT == 2 )); then\n"
      "    _describe verb verbs\n"
      "    _files -g '*.pleuel'\n"
      "    return\n"
      "  fi\n"
      "  local verb=$words[2]\n"
      "  shift words; (( CURRENT-- ))\n"
      "  case $verb in");
  for (const cli_verb* v = cli_verbs; v->name; v++) {
    printf("    %s) _arguments", v->name);
    for (const cli_flag* f = v->flags; f->name; f++) {
      printf(" \\\n      '%s--%s[", f->kind == CLI_SETTING ? "*" : "", f->name);
      zsh_text(f->help);
      putchar(']');
      if (f->kind == CLI_CHOICE) {
        fputs(":word:(", stdout);
        print_choice(f->argument);
        putchar(')');
      } else if (f->kind != CLI_SWITCH && f->kind != CLI_OPTIONAL) {
        fputs(f->letter == 'o' ? ":file:_files" : ":value:", stdout);
      }
      putchar('\'');
    }
    puts(" \\\n      '*:file:_files -g \"*.pleuel\"' ;;");
  }
  puts("    *) _files -g '*.pleuel' ;;\n  esac\n}\n_pleuel \"$@\"");
}

static void fish_text(const char* s) {
  putchar('\'');
  for (; *s; s++) {
    if (*s == '\'' || *s == '\\') putchar('\\');
    putchar(*s);
  }
  putchar('\'');
}

static void fish(void) {
  puts(
      "# fish completion for pleuel; made by `pleuel completion fish`\n"
      "complete -c pleuel -f\n"
      "complete -c pleuel -k -a '(__fish_complete_suffix .pleuel)'");
  for (const cli_verb* v = cli_verbs; v->name; v++) {
    printf("complete -c pleuel -n __fish_use_subcommand -a %s -d ", v->name);
    fish_text(v->summary);
    putchar('\n');
    for (const cli_flag* f = v->flags; f->name; f++) {
      printf("complete -c pleuel -n '__fish_seen_subcommand_from %s' -l %s", v->name, f->name);
      if (f->letter) printf(" -s %c", f->letter);
      if (f->kind == CLI_CHOICE) {
        fputs(" -x -a '", stdout);
        print_choice(f->argument);
        putchar('\'');
      } else if (f->kind != CLI_SWITCH && f->kind != CLI_OPTIONAL) {
        fputs(f->letter == 'o' ? " -r -F" : " -x", stdout);
      }
      fputs(" -d ", stdout);
      fish_text(f->help);
      putchar('\n');
    }
  }
}

int verb_completion(pleuel* ctx, const cli_options* o) {
  (void)ctx;
  static const struct {
    const char* name;
    void (*print)(void);
  } shells[] = {{"bash", bash}, {"zsh", zsh}, {"fish", fish}};
  for (size_t i = 0; o->n_files == 1 && i < sizeof shells / sizeof *shells; i++) {
    if (strcmp(o->files[0], shells[i].name) == 0) {
      shells[i].print();
      return EXIT_DONE;
    }
  }
  return cli_error(EXIT_USAGE, "completion takes one of: bash zsh fish");
}

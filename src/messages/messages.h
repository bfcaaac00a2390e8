// messages: the sentences of the program in two languages.  English stands in the code, where it
// is needed, and is the key; German stands beside it in src/messages/*.def, once.
//
//   pl_say(d, PL_BOTH("{1} is cyclic."), 1, x)         both languages, as two arguments
//   pl_say(d, PL_BOTH_FORMAT(a, "%d steps", n), 0)     formatted; the compiler checks %d in both
//   pl_format(a, pl_german("on %s"), name)             German alone
//   static const char* const kind = PL_KEY("a mass");  in a table; pl_german(kind) where it is used
//
// tools/check_sentences.py finds what lacks German, what nobody says, and other conversions.
#ifndef PL_MESSAGES_H
#define PL_MESSAGES_H

// pl_german gives the German of a sentence that stands in a list, else the sentence itself.
#if defined(__GNUC__)
__attribute__((format_arg(1)))
#endif
const char*
pl_german(const char* english);

#define PL_BOTH(english) (english), pl_german(english)
#define PL_BOTH_FORMAT(arena, english, ...) \
  pl_format(arena, english, __VA_ARGS__), pl_format(arena, pl_german(english), __VA_ARGS__)
#define PL_KEY(english) english

#endif

#include "cli/edit/line_source.hpp"

#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <iostream>

#ifdef BOUGH_LIBEDIT
#include <editline/readline.h>
#endif

namespace bough::cli {

bool is_at_terminal() { return isatty(STDIN_FILENO) != 0 && isatty(STDOUT_FILENO) != 0; }

#ifdef BOUGH_LIBEDIT

namespace {

/// libedit calls back functions without data of their own.
const Complete* complete_now = nullptr;

char* offer_word(const char* /*word*/, int state) {
  static std::vector<std::string> words;
  static std::size_t next = 0;
  if (state == 0) {
    const std::string line(rl_line_buffer, static_cast<std::size_t>(rl_point));
    words = complete_now != nullptr && *complete_now ? (*complete_now)(line) : std::vector<std::string>{};
    next = 0;
  }
  return next < words.size() ? ::strdup(words[next++].c_str()) : nullptr;
}

char** offer_words(const char* word, int /*begin*/, int /*end*/) {
  rl_attempted_completion_over = 1;
  rl_completion_append_character = '\0';
  return rl_completion_matches(word, offer_word);
}

}  // namespace

std::optional<std::string> read_line(const std::string& prompt, const Complete& complete) {
  if (is_at_terminal()) {
    static char breaks[] = " \t";
    rl_basic_word_break_characters = breaks;
    rl_attempted_completion_function = offer_words;
    complete_now = &complete;
    char* line = readline(prompt.c_str());
    complete_now = nullptr;
    if (line == nullptr) return std::nullopt;
    std::string text(line);
    std::free(line);
    if (!text.empty() && complete) add_history(text.c_str());
    return text;
  }
#else
std::optional<std::string> read_line(const std::string& prompt, const Complete& /*complete*/) {
  if (is_at_terminal()) std::cout << prompt << std::flush;
#endif
  std::string line;
  if (!std::getline(std::cin, line)) return std::nullopt;
  return line;
}

}  // namespace bough::cli

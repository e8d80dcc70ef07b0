#include "cli/edit/line_source.hpp"

#include <unistd.h>

#include <csignal>
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

/// Callbacks of libedit have no user data.
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
  // A word is done, but for a key that waits for its value and a table that waits for its key.
  const auto words = complete_now != nullptr && *complete_now
                         ? (*complete_now)(std::string(rl_line_buffer, static_cast<std::size_t>(rl_point)))
                         : std::vector<std::string>{};
  const bool is_open = words.size() != 1 || words.front().empty() || std::strchr("=.", words.front().back()) != nullptr;
  rl_completion_append_character = is_open ? '\0' : ' ';
  return rl_completion_matches(word, offer_word);
}

volatile std::sig_atomic_t is_left = 0;

void leave_line(int /*signal*/) { is_left = 1; }

/// While it lives SIGINT ends the line that is read, not the session with all that was not saved.
class LineInterrupt {
 public:
  LineInterrupt() {
    struct sigaction now {};
    now.sa_handler = leave_line;  // without SA_RESTART: readline comes back
    sigemptyset(&now.sa_mask);
    is_left = 0;
    sigaction(SIGINT, &now, &before_);
  }
  ~LineInterrupt() { sigaction(SIGINT, &before_, nullptr); }
  LineInterrupt(const LineInterrupt&) = delete;
  LineInterrupt& operator=(const LineInterrupt&) = delete;

 private:
  struct sigaction before_ {};
};

}  // namespace

bool was_left() { return is_left != 0; }

std::optional<std::string> read_line(const std::string& prompt, const Complete& complete) {
  if (is_at_terminal()) {
    static char breaks[] = " \t";
    rl_basic_word_break_characters = breaks;
    rl_attempted_completion_function = offer_words;
    complete_now = &complete;
    char* line = nullptr;
    {
      const LineInterrupt interrupt;
      line = readline(prompt.c_str());
    }
    complete_now = nullptr;
    if (line == nullptr) return was_left() && complete ? std::optional<std::string>("") : std::nullopt;
    std::string text(line);
    std::free(line);
    if (!text.empty() && complete) add_history(text.c_str());
    return text;
  }
#else
bool was_left() { return false; }

std::optional<std::string> read_line(const std::string& prompt, const Complete& /*complete*/) {
  if (is_at_terminal()) std::cout << prompt << std::flush;
#endif
  std::string line;
  if (!std::getline(std::cin, line)) return std::nullopt;
  return line;
}

}  // namespace bough::cli

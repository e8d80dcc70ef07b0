#pragma once
/// \file Datasets of a universal file (UFF).
#include "formats/matrices/detail/input.hpp"

namespace bough::matrices::detail {

class UffInput : public TextInput {
 public:
  /// Reads the file. \throws InputError as read_bytes().
  explicit UffInput(const std::string& path) : TextInput(path, read_bytes(path)) {}

  /// Calls read(number, word) at the head of each dataset; `word` is its number as written, "58b" for example. read()
  /// returns after the last line of the dataset. Throws "matrices.truncated", "matrices.bad-number".
  template <class Read>
  void read_datasets(const Read& read) {
    while (next_line()) {
      if (trim(get_line()) != "-1") continue;
      demand_line("the number of a dataset");
      const auto words = split(get_line());
      if (words.empty()) fail_line("the number of a dataset");
      if (words.front() == "58b")
        fail("matrices.uff", "dataset 58b is binary", "export the functions as text (dataset 58)");
      const auto number = parse_integer(words.front());
      if (!number) fail_line("the number of a dataset");
      read(*number);
    }
  }
  /// Reads the next line of a dataset; false at its end.
  bool next_of_dataset() {
    demand_line("the end of the dataset, -1");
    return trim(get_line()) != "-1";
  }
  /// Reads the next line of a dataset, which is not its end.
  void demand_of_dataset(const char* expected) {
    if (!next_of_dataset()) fail_line(expected);
  }
  /// Reads to the end of a dataset.
  void skip_dataset() {
    while (next_of_dataset()) continue;
  }
};

}  // namespace bough::matrices::detail

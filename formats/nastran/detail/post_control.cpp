#include "formats/nastran/detail/post_control.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include "formats/nastran/detail/dynamic_control.hpp"
#include "formats/nastran/detail/text.hpp"

namespace bough::nastran::detail {
namespace {

using records::StressField;

/// Words of a command, with commas, equals signs and brackets as separators.
std::vector<std::string> split_words(std::string_view text) {
  std::string plain(text);
  std::replace_if(
      plain.begin(), plain.end(), [](char c) { return c == ',' || c == '=' || c == '(' || c == ')' || c == '\t'; },
      ' ');
  std::vector<std::string> words;
  for (auto rest = trim(plain); !rest.empty();) {
    const auto word = rest.substr(0, rest.find(' '));
    words.push_back(make_upper(word));
    rest = trim(rest.substr(word.size()));
  }
  return words;
}

/// 1 to 3 for X1 to X3 or X, Y, Z; 0: none of them.
int find_axis(std::string_view word) {
  if (word == "X" || word == "X1") return 1;
  if (word == "Y" || word == "X2") return 2;
  return word == "Z" || word == "X3" ? 3 : 0;
}

/// Reads the words of SURFACE and VOLUME one after the other.
class FieldReader {
 public:
  FieldReader(std::vector<std::string> words, StressField& field) : words_(std::move(words)), field_(field) {}

  /// Returns what is wrong; empty: nothing.
  std::string read() {
    if (!read_id(field_.id)) return "an id of 1 or more after the command";
    while (at_ < words_.size())
      if (!read_word(words_[at_++])) return "words of the command, found " + words_[at_ - 1];
    if (field_.set == 0 && !field_.is_volume) return "SET with the id of a SET of elements";
    if (field_.fibres.empty()) field_.fibres = {"Z1", "Z2", "MID"};
    if (has_principal_ || has_direct_) {
      field_.has_principal = has_principal_;
      field_.has_direct = has_direct_;
    }
    return {};
  }

 private:
  bool read_id(int& id) {
    const auto value = at_ < words_.size() ? parse_int(words_[at_]) : std::nullopt;
    if (!value || *value < 1) return false;
    id = *value;
    ++at_;
    return true;
  }
  bool takes(std::string_view word) {
    if (at_ >= words_.size() || words_[at_] != word) return false;
    ++at_;
    return true;
  }

  bool read_word(const std::string& word) {
    if (word == "SET") return read_id(field_.set);
    if (word == "SYSTEM") return read_system();
    if (field_.is_volume) {
      if (word == "PRINCIPAL") return has_principal_ = true;
      if (word == "DIRECT") return has_direct_ = true;
      return word == "STRESS";
    }
    if (word == "FIBRE" || word == "FIBER") return read_fibres();
    if (word == "AXIS") {
      field_.axis = at_ < words_.size() ? find_axis(words_[at_++]) : 0;
      return field_.axis > 0;
    }
    if (word == "NORMAL") return read_normal();
    if (word == "TOPOLOGICAL") return true;
    if (word == "GEOMETRIC") return field_.is_geometric = true;
    if (word == "TOLERANCE") {
      const auto value = at_ < words_.size() ? parse_real(words_[at_++]) : std::nullopt;
      field_.tolerance = value.value_or(0);
      if (field_.tolerance != 0 && !has_branch_) field_.has_break = true;
      return value.has_value();
    }
    if (word == "BRANCH") return read_branch();
    return false;
  }

  bool read_system() {
    if (takes("BASIC")) return true;
    if (takes("ELEMENT")) {
      field_.system = StressField::System::Element;
      return true;
    }
    field_.system = StressField::System::Cord;
    return takes("CORD") && read_id(field_.cid);
  }
  bool read_fibres() {
    if (takes("ALL")) return true;
    for (bool has_more = true; has_more;) {
      has_more = false;
      for (const char* fibre : {"Z1", "Z2", "MID"})
        if (takes(fibre)) has_more = field_.fibres.insert(fibre).second || has_more;
    }
    return !field_.fibres.empty();
  }
  bool read_normal() {
    if (at_ >= words_.size()) return false;
    std::string word = words_[at_++];
    field_.is_reversed = word.size() > 1 && word.front() == 'M';
    if (field_.is_reversed) word.erase(0, 1);
    const int axis = find_axis(word);
    field_.normal = axis > 0 ? "X" + std::to_string(axis) : word;
    return axis > 0 || word == "R";
  }
  bool read_branch() {
    has_branch_ = true;
    field_.has_break = false;
    bool has_any = false;
    for (bool has_more = true; has_more; has_any = has_any || has_more) {
      has_more = takes("NOBREAK") || takes("MESSAGE") || takes("NOMESSAGE");
      if (!has_more && takes("BREAK")) has_more = field_.has_break = true;
    }
    return has_any;
  }

  std::vector<std::string> words_;
  StressField& field_;
  std::size_t at_ = 0;
  bool has_principal_ = false, has_direct_ = false, has_branch_ = false;
};

}  // namespace

void read_post_command(const Command& c, records::CardLocation at, const SourceLocation& place,
                       records::CaseRequests& requests, Diagnostics& diagnostics) {
  const auto fail = [&](const std::string& expected) {
    diagnostics.error("deck.case-control-value", place, c.word + " " + std::string(c.value) + ": expected " + expected,
                      "write it as in the Quick Reference Guide, such as SURFACE 10 SET 9 NORMAL X3");
  };
  if (c.word == "SET") {
    const auto id_text = find_first_word(c.value);
    const auto id = parse_int(id_text);
    auto list = trim(c.value.substr(id_text.size()));
    if (!list.empty() && list.front() == '=') list = trim(list.substr(1));
    auto set = read_case_set(list);
    if (!id || !set) return fail("SET n = ids");
    requests.post_sets[*id] = std::move(*set);
    return;
  }
  const bool is_volume = is_command(c.word, "VOLUME", 4);
  if (!is_volume && !is_command(c.word, "SURFACE", 4)) return;
  StressField field;
  field.is_volume = is_volume;
  field.at = at;
  if (const auto expected = FieldReader(split_words(c.value), field).read(); !expected.empty()) return fail(expected);
  requests.stress_fields.push_back(std::move(field));
}

}  // namespace bough::nastran::detail

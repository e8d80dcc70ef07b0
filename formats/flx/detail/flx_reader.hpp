#pragma once
/// \file Reads one body of Bough's own layout, by the labels of its lines.
#include <functional>
#include <istream>
#include <map>
#include <unordered_map>

#include "base/diagnostic.hpp"
#include "formats/flx/flx_file.hpp"

namespace bough::flx::detail {

/// Nodes in their order, found by id.
struct NodeList {
  std::vector<int>& ids;
  std::unordered_map<int, int> position = {};
  /// -1 when it is not there.
  int find(int id) const;
  /// -1 when it is there already, or the list is full.
  int add(int id, int max_count);
};

class FlxReader {
 public:
  /// `line`: of the file, counted on from body to body.
  FlxReader(const std::string& path, std::istream& in, int& line) : path_(path), in_(in), line_(line) {}

  /// From the first line of a body, in words already, to its END.
  FlxFile read(const std::vector<std::string>& first);

 private:
  /// Destination of the values of a label.
  using Slot = double*;
  struct Label {
    std::string shape;  ///< the indices before the values: m new node, n node, s special node, j k modes, a axis,
                        ///< l inertial load, e locator
    std::function<Slot(const std::vector<int>&, int)> place;  ///< of the v-th value
    bool runs = false;                                        ///< values run over the last index to its end
    int count = 3;                                            ///< of the values where they do not run
  };

  void check_version(const std::vector<std::string>& first);
  void read_text_line(const std::string& line);
  void add_labels();
  void add_extension_labels();
  std::string describe(const std::string& word);
  bool read_line();
  bool read_extension(const std::string& label, const std::string& line);
  bool read_locator();
  bool read_mode();
  bool read_kind();
  bool read_values(const Label& label);
  int read_index(char kind, const std::string& word);
  bool size();
  void size_locators();
  void check(const char* label, bool is_complete);
  void check_complete();
  void check_extension();

  std::string path_;
  std::istream& in_;
  int& line_;
  FlxFile file_;
  Diagnostics diagnostics_;
  NodeList nodes_{file_.node_id}, special_nodes_{file_.special_id};
  std::map<std::string, Label> labels_;
  std::vector<std::string> words_;
  int minor_ = 0;  ///< of the version
  int num_modes_ = -1, num_nodes_ = -1, num_special_ = -1, num_locators_ = -1;
  double bytes_ = 0;  ///< of the file
  bool is_sized_ = false, ended_ = false, has_frame_ = false;
};

/// Whole and finite or not is for the caller; false if the word is no number of this kind.
bool parse_value(const std::string& word, double& value);
bool parse_value(const std::string& word, int& value);
/// Returns the words between blanks.
std::vector<std::string> split_blanks(const std::string& line);

}  // namespace bough::flx::detail

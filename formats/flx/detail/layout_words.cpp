#include "formats/flx/detail/layout_words.hpp"

namespace bough::flx {

const std::vector<BlockInfo>& get_blocks() {
  static const std::vector<BlockInfo> blocks{{"modes", "j"},
                                             {"mass", "jk"},
                                             {"stiffness", "jk"},
                                             {"damping", "jk"},
                                             {"mass_diagonal", "j"},
                                             {"stiffness_diagonal", "j"},
                                             {"damping_diagonal", "j"},
                                             {"alpha", "ja"},
                                             {"gamma0", "ja"},
                                             {"gamma1", "ja"},
                                             {"gamma2", "jka"},
                                             {"gamma3", "jab"},
                                             {"gamma4", "jkab"},
                                             {"node_id", "i"},
                                             {"node_xyz", "ia"},
                                             {"phi", "ija"},
                                             {"psi", "ija"},
                                             {"gains", "ijd"},
                                             {"cg", "a"},
                                             {"inertia", "ab"},
                                             {"kg_inertial", "ljk"},
                                             {"kg_external", "ejk"},
                                             {"external_load", "ej"},
                                             {"load_resultant", "ed"},
                                             {"load_moment", "eaj"},
                                             {"kg_preload", "jk"},
                                             {"preload_factor", "l"}};
  return blocks;
}

namespace detail {

const std::vector<FieldInfo>& get_fields() {
  static const std::vector<FieldInfo> fields{{"body_id", ""},
                                             {"name", "", true},
                                             {"modopt", ""},
                                             {"method", "", true},
                                             {"mass", ""},
                                             {"digits", ""},
                                             {"num_modes", ""},
                                             {"num_nodes", ""},
                                             {"num_special", ""},
                                             {"num_locators", ""},
                                             {"version", "", true},
                                             {"frame", "", true},
                                             {"interface", "", true},
                                             {"preload", "", true},
                                             {"i", "i"},
                                             {"j", "j"},
                                             {"k", "k"},
                                             {"a", "a"},
                                             {"b", "b"},
                                             {"d", "d"},
                                             {"l", "l"},
                                             {"e", "e"},
                                             {"node", "i"},
                                             {"mode", "j"},
                                             {"mode_k", "k"},
                                             {"kind", "j", true},
                                             {"locator", "e", true},
                                             {"locator_node", "e"},
                                             {"locator_direction", "e"}};
  return fields;
}

bool split(const std::string& line, std::vector<std::string>& words) {
  std::size_t i = 0;
  const auto is_blank = [&](std::size_t at) { return line[at] == ' ' || line[at] == '\t' || line[at] == '\r'; };
  while (i < line.size()) {
    if (is_blank(i)) {
      ++i;
      continue;
    }
    if (line[i] == '#') break;
    std::string word;
    bool quoted = false;
    for (; i < line.size() && (quoted || !is_blank(i)); ++i) {
      if (line[i] == '"') {
        quoted = !quoted;
      } else if (quoted && line[i] == '\\' && i + 1 < line.size()) {
        const char c = line[++i];
        word += c == 'n' ? '\n' : c;
      } else {
        word += line[i];
      }
    }
    if (quoted) return false;
    words.push_back(word);
  }
  return true;
}

}  // namespace detail

}  // namespace bough::flx

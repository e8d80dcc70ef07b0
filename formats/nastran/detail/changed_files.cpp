#include "formats/nastran/detail/changed_files.hpp"

#include <algorithm>
#include <filesystem>
#include <set>
#include <string_view>

namespace bough::nastran::detail {

namespace {

/// The lines of a text, each with its line end.
std::vector<std::string_view> split_text(std::string_view text) {
  std::vector<std::string_view> lines;
  while (!text.empty()) {
    const auto end = text.find('\n');
    const auto size = end == std::string_view::npos ? text.size() : end + 1;
    lines.push_back(text.substr(0, size));
    text.remove_prefix(size);
  }
  return lines;
}

/// Where the comment or the trailing blanks and the line end begin.
std::size_t find_tail(std::string_view line) {
  auto size = std::min(line.find('$'), line.size());
  while (size > 0 &&
         (line[size - 1] == ' ' || line[size - 1] == '\t' || line[size - 1] == '\r' || line[size - 1] == '\n'))
    --size;
  return size;
}

std::string quote_path(const std::string& path) {
  const char quote = path.find('\'') == std::string::npos ? '\'' : '"';
  return quote + path + quote;
}

}  // namespace

std::vector<EditedFile> write_changed_files(const Source& source, const std::string& name,
                                            const std::map<int, LineChange>& changes) {
  std::map<int, std::map<int, const LineChange*>> by_file;  // file, line number
  for (const auto& [line, change] : changes) {
    const auto& at = source.lines[static_cast<std::size_t>(line)].at;
    by_file[at.file][at.line] = &change;
  }
  // A file that includes a written file is written too.
  std::set<int> written{0};
  for (const auto& [file, unused] : by_file) written.insert(file);
  for (bool is_complete = false; !is_complete;) {
    is_complete = true;
    for (const auto& include : source.includes)
      if (written.count(include.target) > 0 && written.insert(include.file).second) is_complete = false;
  }
  std::map<int, std::string> names{{0, name}};
  for (const int file : written)
    if (file != 0) names[file] = name + ".include" + std::to_string(file);

  std::vector<EditedFile> result;
  for (const int file : written) {
    EditedFile edited{names.at(file), {}};
    const auto lines = split_text(source.texts[static_cast<std::size_t>(file)]);
    for (std::size_t i = 0; i < lines.size(); ++i) {
      const int number = static_cast<int>(i) + 1;
      const auto include = std::find_if(source.includes.begin(), source.includes.end(),
                                        [&](const auto& at) { return at.file == file && at.first_line == number; });
      const auto of_file = by_file.find(file);
      const LineChange* change = nullptr;
      if (of_file != by_file.end())
        if (const auto at = of_file->second.find(number); at != of_file->second.end()) change = at->second;
      if (include != source.includes.end()) {
        const auto target = names.find(include->target);
        const auto path =
            std::filesystem::absolute(source.files[static_cast<std::size_t>(include->target)]).lexically_normal();
        edited.text += "INCLUDE " + quote_path(target == names.end() ? path.string() : target->second) + "\n";
        i += static_cast<std::size_t>(include->last_line - include->first_line);
      } else if (change != nullptr) {
        const auto tail = lines[i].substr(find_tail(lines[i]));
        edited.text += change->text;
        edited.text += tail;
        if (!change->added.empty() && (tail.empty() || tail.back() != '\n')) edited.text += '\n';
        edited.text += change->added;
      } else {
        edited.text += lines[i];
      }
    }
    result.push_back(std::move(edited));
  }
  return result;
}

}  // namespace bough::nastran::detail

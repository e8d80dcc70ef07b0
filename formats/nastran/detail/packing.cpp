#include "formats/nastran/detail/packing.hpp"

#include <cstring>

namespace bough::nastran::detail {
namespace {

void put(std::string& bytes, int number) { bytes.append(reinterpret_cast<const char*>(&number), sizeof number); }

void put(std::string& bytes, std::string_view text) {
  put(bytes, static_cast<int>(text.size()));
  bytes += text;
}

class Taker {
 public:
  explicit Taker(std::string_view bytes) : rest_(bytes) {}
  int take_number() {
    int number = 0;
    BOUGH_DEMAND(rest_.size() >= sizeof number);
    std::memcpy(&number, rest_.data(), sizeof number);
    rest_.remove_prefix(sizeof number);
    return number;
  }
  std::string_view take_text() {
    const auto size = static_cast<std::size_t>(take_number());
    BOUGH_DEMAND(rest_.size() >= size);
    const auto text = rest_.substr(0, size);
    rest_.remove_prefix(size);
    return text;
  }
  std::string take_string() { return std::string(take_text()); }

 private:
  std::string_view rest_;
};

}  // namespace

std::string pack(const Source& source, const Diagnostics& diagnostics) {
  std::string bytes;
  std::size_t size = 0;
  for (const auto& line : source.lines) size += line.text.size() + 3 * sizeof(int);
  bytes.reserve(size + 4096);
  put(bytes, static_cast<int>(diagnostics.items().size()));
  for (const auto& item : diagnostics.items()) {
    put(bytes, static_cast<int>(item.severity));
    put(bytes, item.where.line);
    put(bytes, item.where.column);
    for (const auto* text : {&item.id, &item.where.file, &item.what, &item.advice}) put(bytes, *text);
  }
  put(bytes, static_cast<int>(source.files.size()));
  for (const auto& file : source.files) put(bytes, file);
  put(bytes, static_cast<int>(source.lines.size()));
  for (const auto& line : source.lines) {
    put(bytes, line.at.file);
    put(bytes, line.at.line);
    put(bytes, line.text);
  }
  return bytes;
}

Source unpack(std::string bytes, Diagnostics& diagnostics) {
  Source source;
  source.storage.push_back(std::move(bytes));
  Taker taker(source.storage.back());
  for (int i = taker.take_number(); i > 0; --i) {
    Diagnostic item;
    item.severity = static_cast<Severity>(taker.take_number());
    item.where.line = taker.take_number();
    item.where.column = taker.take_number();
    for (auto* text : {&item.id, &item.where.file, &item.what, &item.advice}) *text = taker.take_string();
    diagnostics.add(std::move(item));
  }
  for (int i = taker.take_number(); i > 0; --i) source.files.push_back(taker.take_string());
  source.lines.resize(static_cast<std::size_t>(taker.take_number()));
  for (auto& line : source.lines) {
    line.at.file = taker.take_number();
    line.at.line = taker.take_number();
    line.text = taker.take_text();
  }
  return source;
}

}  // namespace bough::nastran::detail

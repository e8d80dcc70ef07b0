#include "base/foreign_call.hpp"

#include <atomic>
#include <charconv>
#include <cmath>
#include <cstring>

namespace bough {

namespace {

using Slot = const ForeignCall* volatile;

// Initial-exec: a signal handler may not allocate the storage of a thread.
__attribute__((tls_model("initial-exec"))) thread_local Slot g_current = nullptr;
std::atomic<Slot*> g_first_thread{nullptr};
std::atomic<void (*)()> g_guard{nullptr};

constexpr char kPrefix[] = "bough_controller_";

/// Text of limited length.
class Writer {
 public:
  Writer(char* to, std::size_t size) : begin_(to), at_(to), end_(to + size) {}
  void add(const char* text, std::size_t size) {
    const auto room = static_cast<std::size_t>(end_ - at_);
    std::memcpy(at_, text, size < room ? size : room);
    at_ += size < room ? size : room;
  }
  void add(const char* text) { add(text, std::strlen(text)); }
  void add(const std::string& text) { add(text.data(), text.size()); }
  void add(double value) {
    const auto written = std::to_chars(at_, end_, value, std::chars_format::general, 6);
    if (written.ec == std::errc()) at_ = written.ptr;
  }
  std::size_t size() const { return static_cast<std::size_t>(at_ - begin_); }

 private:
  char *begin_, *at_, *end_;
};

}  // namespace

ForeignCall::ForeignCall(const SourceLocation& at, const std::string& label, const std::string& language,
                         const char* function, double time)
    : at_(at), label_(label), language_(language), function_(function), time_(time), outer_(g_current) {
  if (g_guard.load(std::memory_order_relaxed) != nullptr) {
    g_first_thread.store(&g_current);
    if (const auto install = g_guard.exchange(nullptr)) install();
  }
  g_current = this;
}

ForeignCall::~ForeignCall() { g_current = outer_; }

std::size_t ForeignCall::describe(char* to, std::size_t size) const noexcept {
  Writer text(to, size);
  text.add(label_);
  text.add(": ");
  const bool is_lent = !language_.empty() && std::strncmp(function_, kPrefix, sizeof kPrefix - 1) == 0;
  text.add(is_lent ? function_ + sizeof kPrefix - 1 : function_);
  if (is_lent) {
    text.add(" of its ");
    text.add(language_);
    text.add(" law");
  }
  if (!std::isnan(time_)) {
    text.add(" at t = ");
    text.add(time_);
  }
  return text.size();
}

std::string ForeignCall::describe() const {
  char text[1000];
  return {text, describe(text, sizeof text)};
}

const ForeignCall* ForeignCall::find_current() noexcept {
  if (g_current != nullptr) return g_current;
  const Slot* first = g_first_thread.load();
  return first != nullptr ? *first : nullptr;
}

void ForeignCall::set_guard(void (*install)()) noexcept { g_guard.store(install); }

}  // namespace bough

#include "cli/studio/server.hpp"

#include <httplib.h>
#include <sys/random.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <thread>

#include "base/diagnostic.hpp"
#include "base/version.hpp"
#include "cli/studio/child.hpp"
#include "cli/studio/commands.hpp"
#include "cli/studio/web_files.hpp"

namespace bough::cli {

using nlohmann::json;

namespace {

constexpr std::size_t kMaxRequest = std::size_t{8} << 20;  ///< [bytes]; texts have at most 4 MB
constexpr int kMaxSeconds = 300;                           ///< of one answer
constexpr int kNumThreads = 16;
constexpr std::size_t kMaxJobs = 8;  ///< that go on at the same time

std::string make_token() {
  unsigned char bytes[16];
  if (getentropy(bytes, sizeof bytes) != 0)
    throw ComputationError("studio.no-process", {}, "the system gives no random numbers", "try again");
  std::string token;
  for (const unsigned char byte : bytes) {
    token += "0123456789abcdef"[byte >> 4];
    token += "0123456789abcdef"[byte & 15];
  }
  return token;
}

/// Compares in a time that does not depend on the first difference.
bool is_same(const std::string& a, const std::string& b) {
  unsigned difference = a.size() == b.size() ? 0 : 1;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    difference |= static_cast<unsigned>(static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(b[i]));
  return difference == 0;
}

/// Types that the library does not compress: Brotli at its best takes seconds for a mesh, and nothing leaves the
/// machine.
constexpr const char* kJson = "application/json; charset=utf-8";

const char* get_type(std::string_view name) {
  if (name.ends_with(".js")) return "application/javascript; charset=utf-8";
  if (name.ends_with(".css")) return "text/css; charset=utf-8";
  return "text/html; charset=utf-8";
}

std::string dump(const json& value) { return value.dump(-1, ' ', false, json::error_handler_t::replace); }

std::string make_error(const std::string& id, const std::string& what, const std::string& advice) {
  return dump({{"messages",
                {{{"severity", "error"}, {"id", id}, {"file", ""}, {"line", 0}, {"what", what}, {"advice", advice}}}}});
}

}  // namespace

struct StudioServer::Parts {
  explicit Parts(ServerOptions given) : options(std::move(given)), token(make_token()) {}

  ServerOptions options;
  std::string token;
  int port = 0;
  httplib::Server server;
  std::thread thread;
  std::atomic<bool> is_running{false};
  std::mutex mutex;
  struct StartedJob {
    std::unique_ptr<Job> job;
    json request;      ///< as the page sent it
    std::string line;  ///< for a shell
    bool is_running() const { return job->get_state(Job::kMaxOutput).is_running; }
  };
  std::map<int, StartedJob> jobs;

  bool is_own_host(const std::string& host) const {
    const auto number = ":" + std::to_string(port);
    return host == "127.0.0.1" + number || host == "localhost" + number;
  }

  /// Refuses requests of other pages, of other names of this machine (DNS rebinding) and without the token.
  bool is_refused(const httplib::Request& request) const {
    const auto host = request.get_header_value("Host");
    if (request.get_header_value_count("Host") != 1 || !is_own_host(host)) return true;
    const auto origin = request.get_header_value("Origin");
    const bool changes = request.method == "POST";
    if ((changes || !origin.empty()) && origin != "http://" + host) return true;
    const auto site = request.get_header_value("Sec-Fetch-Site");
    if (!site.empty() && site != "same-origin" && site != "none") return true;
    if (changes && request.get_header_value("Content-Type") != "application/json") return true;
    const auto end = request.path.find('/', 1);
    return request.path.empty() || end == std::string::npos || !is_same(request.path.substr(1, end - 1), token);
  }

  static void add_headers(httplib::Response& response) {
    response.set_header("Content-Security-Policy",
                        "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob: data:; "
                        "media-src blob:; connect-src 'self'; base-uri 'none'; form-action 'none'; "
                        "frame-ancestors 'none'");
    response.set_header("X-Content-Type-Options", "nosniff");
    response.set_header("X-Frame-Options", "DENY");
    response.set_header("Referrer-Policy", "no-referrer");
    response.set_header("Cross-Origin-Resource-Policy", "same-origin");
    response.set_header("Cross-Origin-Opener-Policy", "same-origin");
    response.set_header("Cache-Control", "no-store");
  }

  void serve_file(const httplib::Request& request, httplib::Response& response) const {
    auto name = request.path.substr(token.size() + 2);
    if (name.empty()) name = "studio.html";
    for (const auto& file : get_web_files()) {
      if (file.name != name) continue;
      response.set_content(file.text.data(), file.text.size(), get_type(file.name));
      return;
    }
    response.status = 404;
    response.set_content("not found\n", "text/plain");
  }

  std::string answer(const std::string& name, const std::string& body) {
    if (name == "ask") return ask(body);
    const json request = json::parse(body);
    if (name == "state")
      return dump({{"result",
                    {{"files", options.files},
                     {"folder", std::filesystem::path(options.folder).filename().string()},
                     {"version", get_version()}}}});
    if (name == "start") return start_job(request);
    if (name == "job") return report_job(request);
    if (name == "jobs") return list_jobs();
    if (name == "stop") return stop_job(request);
    if (name == "command") return dump({{"result", {{"line", quote_command(make_command(request, options.folder))}}}});
    if (name == "end") {
      std::thread([this] { server.stop(); }).detach();
      return dump({{"result", json::object()}});
    }
    return make_error("studio.bad-request", "there is no request \"" + name + "\"", "reload the page");
  }

  std::string ask(const std::string& body) const {
    const auto result = run_child({"studio", "--answer"}, options.folder, body, kMaxSeconds);
    if (result.is_late)
      return make_error("studio.no-answer", "the request took longer than five minutes",
                        "run the command in a terminal");
    auto text = result.output;
    if (!text.empty() && text.back() == '\n') text.pop_back();
    text.erase(0, text.rfind('\n') + 1);
    if (result.code != 0 || text.empty())
      return make_error("studio.no-answer", "the process of the request ended with code " + std::to_string(result.code),
                        "run bough check on the file in a terminal");
    return text;
  }

  std::string start_job(const json& request) {
    auto words = make_command(request, options.folder);
    const auto line = quote_command(words);
    words.emplace_back("-v");  // prints the progress as lines
    const std::lock_guard lock(mutex);
    std::size_t running = 0;
    for (const auto& [number, started] : jobs) running += started.is_running() ? 1 : 0;
    if (running >= kMaxJobs)
      return make_error("studio.no-process", "eight commands are running", "stop one, or wait until one ends");
    const int number = jobs.empty() ? 1 : jobs.rbegin()->first + 1;
    jobs.emplace(number, StartedJob{std::make_unique<Job>(std::move(words), options.folder), request, line});
    return dump({{"result", {{"job", number}, {"line", line}}}});
  }

  /// Commands that run, for a page that did not start them: one that was reloaded, another tab.
  std::string list_jobs() {
    const std::lock_guard lock(mutex);
    auto list = json::array();
    for (const auto& [number, started] : jobs)
      if (started.is_running()) list.push_back({{"job", number}, {"line", started.line}, {"request", started.request}});
    return dump({{"result", {{"jobs", list}}}});
  }

  Job& find_job(const json& request) {
    const auto found = jobs.find(request.at("job").get<int>());
    if (found == jobs.end()) throw InputError("studio.bad-request", {}, "there is no such job", "reload the page");
    return *found->second.job;
  }

  std::string report_job(const json& request) {
    const std::lock_guard lock(mutex);
    const auto state = find_job(request).get_state(request.value("from", std::size_t{0}));
    return dump(
        {{"result",
          {{"running", state.is_running}, {"code", state.code}, {"output", state.output}, {"total", state.total}}}});
  }

  std::string stop_job(const json& request) {
    const std::lock_guard lock(mutex);
    find_job(request).stop();
    return dump({{"result", json::object()}});
  }

  void serve_call(const httplib::Request& request, httplib::Response& response) {
    std::string text;
    try {
      text = answer(request.path.substr(token.size() + 6), request.body);
    } catch (const Failure& failure) {
      const auto& item = failure.items().front();
      text = make_error(item.id, item.what, item.advice);
    } catch (const json::exception& error) {
      text = make_error("studio.bad-request", error.what(), "reload the page");
    }
    response.set_content(text, kJson);
  }
};

StudioServer::StudioServer(ServerOptions options) : parts_(std::make_unique<Parts>(std::move(options))) {
  auto& p = *parts_;
  p.server.new_task_queue = [] { return new httplib::ThreadPool(kNumThreads); };
  p.server.set_payload_max_length(kMaxRequest);
  p.server.set_tcp_nodelay(true);
  // Not SO_REUSEPORT, the default of the library: two servers would share a port.
  p.server.set_socket_options([](socket_t socket) {
    const int yes = 1;
    setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  });
  p.server.set_pre_routing_handler([&p](const httplib::Request& request, httplib::Response& response) {
    Parts::add_headers(response);
    const bool is_refused = p.is_refused(request);
    // The library limits no body in chunks, and the page sends none.
    const bool is_chunked = request.has_header("Transfer-Encoding");
    if (!is_refused && !is_chunked) return httplib::Server::HandlerResponse::Unhandled;
    response.status = is_refused ? 403 : 413;
    response.set_content(is_refused ? "refused: open the address that bough studio printed\n" : "a body in chunks\n",
                         "text/plain");
    response.set_header("Connection", "close");  // the body of the request is not read
    return httplib::Server::HandlerResponse::Handled;
  });
  p.server.Get("/[0-9a-f]+/.*",
               [&p](const httplib::Request& request, httplib::Response& response) { p.serve_file(request, response); });
  p.server.Post("/[0-9a-f]+/api/[a-z]+", [&p](const httplib::Request& request, httplib::Response& response) {
    p.serve_call(request, response);
  });
  if (p.options.port == 0)
    p.port = p.server.bind_to_any_port("127.0.0.1");
  else if (p.server.bind_to_port("127.0.0.1", p.options.port))
    p.port = p.options.port;
  if (p.port <= 0)
    throw InputError("studio.no-port", {}, "port " + std::to_string(p.options.port) + " is not free",
                     "choose another with --port, or none for a free one");
}

StudioServer::~StudioServer() { stop(); }

std::string StudioServer::get_address() const {
  return "http://127.0.0.1:" + std::to_string(parts_->port) + "/" + parts_->token + "/";
}

void StudioServer::start() {
  auto& p = *parts_;
  p.is_running = true;
  p.thread = std::thread([&p] {
    p.server.listen_after_bind();
    p.is_running = false;
  });
  // stop() has no effect before the server listens.
  while (p.is_running && !p.server.is_running()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

bool StudioServer::is_running() const { return parts_->is_running; }

void StudioServer::stop() {
  auto& p = *parts_;
  p.server.stop();
  if (p.thread.joinable()) p.thread.join();
  const std::lock_guard lock(p.mutex);
  for (auto& [number, started] : p.jobs) started.job->stop();
  p.jobs.clear();
}

}  // namespace bough::cli

#include "softforce/serve/live_page.h"

#include <fmt/format.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <thread>

#include "serve/connection.h"
#include "serve/connection_threads.h"
#include "serve/origin.h"
#include "softforce/base/input_error.h"
#include "softforce/serve/token.h"

namespace softforce::serve {
namespace {

constexpr char kAddress[] = "127.0.0.1";
constexpr size_t kLargestBody = 4096;            // bytes; controls need none
constexpr std::chrono::milliseconds kTurn{500};  // after which a reader's thread looks around
constexpr std::chrono::seconds kSignOfLife{5};   // to a reader for whom there is nothing new
constexpr int kForbidden = 403, kBusy = 503, kNotFound = 404, kTooLarge = 413;
constexpr int kWaitingClients = 128;

void SetSocketOptions(socket_t socket) {
  const int on = 1;
  // A program that is started again has its port at once; two never share it.
  setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
}

// The server of cpp-httplib with connections of ours.
class Server : public httplib::Server {
 public:
  explicit Server(const ConnectionLimits& limits) : limits_(limits) {}

  // Lets more clients wait for their turn than the five that cpp-httplib is built for: those beyond
  // would try again after a second.
  void LetWait(int clients) { ::listen(svr_sock_, clients); }

 private:
  bool process_and_close_socket(socket_t socket) override {
    bool done = false;
    if (!ConnectionThreads::refused()) {
      Connection connection(socket, limits_);
      bool closed = false;
      // One request each. No parts of files, nothing compressed: neither is worth its risk here.
      done = process_request(connection, true, closed, [](httplib::Request& request) {
        request.ranges.clear();
        request.headers.erase("Accept-Encoding");
      });
    }
    ::shutdown(socket, SHUT_RDWR);
    ::close(socket);
    return done;
  }

  const ConnectionLimits limits_;
};

void Refuse(httplib::Response& response, int status, const std::string& why) {
  response.status = status;
  response.set_content(why + "\n", "text/plain");
}

}  // namespace

void LivePageOptions::Check() const {
  if (port < 0 || port > 65535) {
    throw base::InputError("--serve",
                           fmt::format("got port {}, must lie between 0 and 65535", port),
                           "0 stands for any port that is free.");
  }
  if (token.empty()) throw base::InputError("token", "must not be empty");
  if (max_connections < 1) throw base::InputError("max_connections", "must be 1 or more");
  if (max_readers < 1 || max_readers > max_connections) {
    throw base::InputError("max_readers", "must lie between 1 and max_connections");
  }
}

struct LivePage::State {
  State(const LivePageOptions& given, std::map<std::string, PageFile> page_files,
        std::map<std::string, Control> page_controls, Broadcast* to_read)
      : options(given),
        files(std::move(page_files)),
        controls(std::move(page_controls)),
        broadcast(to_read),
        server({given.longest_request, given.longest_write, &closing}) {}

  bool TurnsAway(const httplib::Request& request, httplib::Response* response) const;
  void SetRoutes();
  void Follow(const httplib::Request& request, httplib::Response& response);
  void ControlBy(const std::string& name, const httplib::Request& request,
                 httplib::Response& response);

  const LivePageOptions options;
  const std::map<std::string, PageFile> files;
  const std::map<std::string, Control> controls;
  Broadcast* const broadcast;
  std::atomic<bool> closing{false};
  Server server;
  int port = 0;
  std::thread thread;
};

// Before anything of its body is read.
bool LivePage::State::TurnsAway(const httplib::Request& request,
                                httplib::Response* response) const {
  if (!IsOwnHost(request.get_header_value("Host"), port) ||
      !IsOwnOrigin(request.get_header_value("Origin"), port)) {
    Refuse(*response, kForbidden, "this page is for its own machine and its own address only");
    return true;
  }
  const std::string length = request.get_header_value("Content-Length");
  const bool small = length.size() <= 4 && length.find_first_not_of("0123456789") == length.npos;
  if (!small || request.has_header("Transfer-Encoding")) {
    Refuse(*response, kTooLarge, "a request has no contents here");
    return true;
  }
  return false;
}

void LivePage::State::Follow(const httplib::Request& /*request*/, httplib::Response& response) {
  if (broadcast->readers() >= options.max_readers) {
    Refuse(response, kBusy, "too many readers");
    return;
  }
  broadcast->AddReader();
  auto seen = std::make_shared<uint64_t>(0);
  auto last = std::make_shared<std::chrono::steady_clock::time_point>();
  response.set_chunked_content_provider(
      "text/event-stream",
      [this, seen, last](size_t /*offset*/, httplib::DataSink& sink) {
        const Broadcast::Newest newest = broadcast->WaitNewer(*seen, kTurn);
        if (closing) return false;
        const auto now = std::chrono::steady_clock::now();
        std::string text;
        if (newest.number > *seen) {
          *seen = newest.number;
          text = "data: " + newest.state->json + "\n\n";
        } else if (now - *last > kSignOfLife) {
          text = ":\n\n";
        }
        if (text.empty()) return true;
        *last = now;
        return sink.write(text.data(), text.size());
      },
      [this](bool /*success*/) { broadcast->RemoveReader(); });
}

void LivePage::State::ControlBy(const std::string& name, const httplib::Request& request,
                                httplib::Response& response) {
  if (!SameToken(request.get_header_value("X-Softforce-Token"), options.token)) {
    Refuse(response, kForbidden, "the token is missing or wrong");
    return;
  }
  controls.at(name)();
  response.set_content("{}", "application/json");
}

void LivePage::State::SetRoutes() {
  for (const auto& [path, file] : files) {
    const PageFile& content = file;
    server.Get(path, [&content](const httplib::Request&, httplib::Response& response) {
      response.set_content(content.content, content.type.c_str());
    });
  }
  for (const auto& [name, control] : controls) {
    const std::string& of = name;
    server.Post("/" + name,
                [this, &of](const httplib::Request& request, httplib::Response& response) {
                  ControlBy(of, request, response);
                });
  }
  server.Get("/events", [this](const httplib::Request& request, httplib::Response& response) {
    Follow(request, response);
  });
  server.Get(R"(/pictures/(\d{1,3}))",
             [this](const httplib::Request& request, httplib::Response& response) {
               const auto state = broadcast->Read().state;
               const auto number = static_cast<size_t>(std::stoi(request.matches[1]));
               if (!state || number >= state->pictures.size()) {
                 return Refuse(response, kNotFound, "there is none yet");
               }
               response.set_content(state->pictures[number], "image/jpeg");
             });
  server.Get("/([a-z]{1,20})",
             [this](const httplib::Request& request, httplib::Response& response) {
               const auto state = broadcast->Read().state;
               if (!state || state->documents.count(request.matches[1]) == 0) {
                 return Refuse(response, kNotFound, "there is none");
               }
               response.set_content(state->documents.at(request.matches[1]), "application/json");
             });
}

LivePage::LivePage(const LivePageOptions& options, std::map<std::string, PageFile> files,
                   std::map<std::string, Control> controls, Broadcast* broadcast) {
  options.Check();
  state_ = std::make_unique<State>(options, std::move(files), std::move(controls), broadcast);
  Server& server = state_->server;
  server.new_task_queue = [this] {
    return new ConnectionThreads(state_->options.max_connections);  // cpp-httplib deletes it
  };
  server.set_socket_options(SetSocketOptions);
  server.set_tcp_nodelay(true);
  server.set_payload_max_length(kLargestBody);
  server.set_default_headers(
      {{"Content-Security-Policy",
        "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob: data:; "
        "connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"},
       {"X-Content-Type-Options", "nosniff"},
       {"Referrer-Policy", "no-referrer"},
       {"Cross-Origin-Resource-Policy", "same-origin"},
       {"Cache-Control", "no-store"}});
  server.set_pre_routing_handler(
      [this](const httplib::Request& request, httplib::Response& response) {
        return state_->TurnsAway(request, &response) ? httplib::Server::HandlerResponse::Handled
                                                     : httplib::Server::HandlerResponse::Unhandled;
      });
  state_->SetRoutes();
  const bool any = options.port == 0;
  state_->port = any ? server.bind_to_any_port(kAddress)
                     : (server.bind_to_port(kAddress, options.port) ? options.port : -1);
  if (state_->port <= 0) {
    throw base::InputError("--serve",
                           fmt::format("port {} of {} cannot be had", options.port, kAddress),
                           "Another program may have it. Choose another, or 0 for any.");
  }
  server.LetWait(kWaitingClients);
  state_->thread = std::thread([this] { state_->server.listen_after_bind(); });
}

LivePage::~LivePage() {
  state_->closing = true;
  state_->broadcast->Close();
  // stop() is without effect before the thread listens.
  while (!state_->server.is_running()) std::this_thread::yield();
  state_->server.stop();
  state_->thread.join();
}

int LivePage::port() const { return state_->port; }

std::string LivePage::Url() const { return fmt::format("http://{}:{}/", kAddress, port()); }

}  // namespace softforce::serve

#pragma once

#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <string>

#include "softforce/serve/broadcast.h"

namespace softforce::serve {

struct LivePageOptions {
  int port = 0;  // of the loopback address; 0: any that is free
  std::string token;
  int max_connections = 64;                           // at a time; more are closed at once
  int max_readers = 24;                               // that follow the states
  std::chrono::milliseconds longest_request{10'000};  // from its first byte to its last
  std::chrono::milliseconds longest_write{5'000};     // that a reader may take for a piece

  void Check() const;  // throws InputError naming the option
};

struct PageFile {
  std::string type;  // as HTTP has it: "text/css"
  std::string content;
};

// Serves a page over HTTP on 127.0.0.1, and what it shows:
//   GET  /, /…        the files
//   GET  /events      the states' JSON as they come (server-sent events)
//   GET  /NAME        a document of the newest state;  /pictures/N: its picture N
//   POST /NAME        a control; needs the header X-Softforce-Token
// Requests must name this machine as their host, and none may come from another site's page.
// Whatever is sent, the writer of the states is not held up: each connection has a thread of lowest
// priority, and there are no more than so many, none for longer than it may take.
class LivePage {
 public:
  using Control = std::function<void()>;

  // Opens the port and serves from now on; the broadcast must outlive it. Throws InputError if the
  // port cannot be had.
  LivePage(const LivePageOptions& options, std::map<std::string, PageFile> files,
           std::map<std::string, Control> controls, Broadcast* broadcast);
  ~LivePage();  // closes the broadcast and all connections

  int port() const;
  std::string Url() const;  // without the token

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace softforce::serve

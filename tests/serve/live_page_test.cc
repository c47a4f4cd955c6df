#include "softforce/serve/live_page.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "serve/raw_client.h"
#include "softforce/base/input_error.h"

namespace softforce::serve {
namespace {

using testing::Ask;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::RawClient;
using ::testing::StartsWith;

constexpr char kToken[] = "0123456789abcdef0123456789abcdef";

class LivePageTest : public ::testing::Test {
 protected:
  static LivePageOptions Options() {
    LivePageOptions options;
    options.token = kToken;
    options.max_readers = 2;
    options.max_connections = 8;
    return options;
  }

  std::string Get(const std::string& path, const std::string& more = "") {
    return Ask(page_.port(), fmt::format("GET {} HTTP/1.1\r\nHost: 127.0.0.1:{}\r\n{}\r\n", path,
                                         page_.port(), more));
  }
  std::string Post(const std::string& path, const std::string& more) {
    return Ask(page_.port(),
               fmt::format("POST {} HTTP/1.1\r\nHost: 127.0.0.1:{}\r\nContent-Length: 0\r\n{}\r\n",
                           path, page_.port(), more));
  }
  std::string Token(const std::string& token = kToken) const {
    return "X-Softforce-Token: " + token + "\r\n";
  }

  Broadcast broadcast_;
  std::atomic<int> tares_{0};
  LivePage page_{Options(),
                 {{"/", {"text/html", "<p>the page"}}},
                 {{"tare", [this] { ++tares_; }}},
                 &broadcast_};
};

TEST_F(LivePageTest, ServesItsFilesWithAStrictPolicy) {
  const std::string answer = Get("/");

  EXPECT_THAT(answer, StartsWith("HTTP/1.1 200"));
  EXPECT_THAT(answer, HasSubstr("<p>the page"));
  EXPECT_THAT(answer, HasSubstr("Content-Security-Policy: default-src 'none'"));
  EXPECT_THAT(answer, HasSubstr("nosniff"));
}

TEST_F(LivePageTest, KnowsNothingElse) {
  EXPECT_THAT(Get("/etc/passwd"), StartsWith("HTTP/1.1 404"));
  EXPECT_THAT(Get("/../etc/passwd"), StartsWith("HTTP/1.1 404"));
  EXPECT_THAT(Get("/view"), StartsWith("HTTP/1.1 404"));
  EXPECT_THAT(Get("/pictures/0"), StartsWith("HTTP/1.1 404"));
}

TEST_F(LivePageTest, ServesTheNewestPictureAndView) {
  broadcast_.Publish(
      std::make_shared<PageState>(PageState{"{}", {{"view", "[1]"}}, {"one", "two"}}));

  EXPECT_THAT(Get("/pictures/1"), HasSubstr("two"));
  EXPECT_THAT(Get("/pictures/2"), StartsWith("HTTP/1.1 404"));
  EXPECT_THAT(Get("/view"), HasSubstr("[1]"));
}

TEST_F(LivePageTest, SendsStatesAsTheyCome) {
  RawClient reader(page_.port());
  reader.Send(fmt::format("GET /events HTTP/1.1\r\nHost: localhost:{}\r\n\r\n", page_.port()));
  broadcast_.Publish(std::make_shared<PageState>(PageState{"{\"n\":1}", {}, {}}));
  EXPECT_THAT(reader.Receive("data: {\"n\":1}\n\n"), HasSubstr("data: {\"n\":1}\n\n"));

  broadcast_.Publish(std::make_shared<PageState>(PageState{"{\"n\":2}", {}, {}}));

  EXPECT_THAT(reader.Receive("data: {\"n\":2}\n\n"), HasSubstr("data: {\"n\":2}\n\n"));
  EXPECT_EQ(broadcast_.readers(), 1);
}

TEST_F(LivePageTest, ControlsWithTheTokenOnly) {
  EXPECT_THAT(Post("/tare", ""), StartsWith("HTTP/1.1 403"));
  EXPECT_THAT(Post("/tare", Token("0123456789abcdef0123456789abcdee")), StartsWith("HTTP/1.1 403"));
  EXPECT_EQ(tares_, 0);

  EXPECT_THAT(Post("/tare", Token()), StartsWith("HTTP/1.1 200"));
  EXPECT_EQ(tares_, 1);
}

TEST_F(LivePageTest, ControlsByPostOnly) {
  EXPECT_THAT(Get("/tare", Token()), StartsWith("HTTP/1.1 404"));
  EXPECT_EQ(tares_, 0);
}

TEST_F(LivePageTest, RefusesOtherSitesEvenWithTheToken) {
  EXPECT_THAT(Post("/tare", Token() + "Origin: http://evil.example\r\n"),
              StartsWith("HTTP/1.1 403"));
  EXPECT_EQ(tares_, 0);
}

TEST_F(LivePageTest, RefusesOtherNamesOfThisMachine) {
  EXPECT_THAT(Ask(page_.port(), "GET / HTTP/1.1\r\nHost: evil.example\r\n\r\n"),
              StartsWith("HTTP/1.1 403"));
}

TEST_F(LivePageTest, NeverTellsTheToken) {
  EXPECT_THAT(Post("/tare", Token()), Not(HasSubstr(kToken)));
  EXPECT_THAT(Post("/tare", Token("wrong")), Not(HasSubstr(kToken)));
  EXPECT_THAT(page_.Url(), Not(HasSubstr(kToken)));
}

TEST_F(LivePageTest, RefusesLargeBodies) {
  RawClient client(page_.port());
  client.Send(
      fmt::format("POST /tare HTTP/1.1\r\nHost: localhost:{}\r\n{}Content-Length: "
                  "1000000\r\n\r\n",
                  page_.port(), Token()));
  client.Send(std::string(10'000, 'x'));

  EXPECT_THAT(client.Receive("413"), StartsWith("HTTP/1.1 413"));
  EXPECT_EQ(tares_, 0);
}

TEST_F(LivePageTest, BoundsThoseWhoFollow) {
  const std::string request =
      fmt::format("GET /events HTTP/1.1\r\nHost: localhost:{}\r\n\r\n", page_.port());
  RawClient first(page_.port()), second(page_.port());
  for (RawClient* client : {&first, &second}) {
    client->Send(request);
    client->Receive("\r\n\r\n");
  }

  EXPECT_THAT(Ask(page_.port(), request), StartsWith("HTTP/1.1 503"));
}

TEST_F(LivePageTest, ClosesWhatIsBeyondTheLargestNumberOfConnections) {
  std::vector<std::unique_ptr<RawClient>> idle;
  for (int i = 0; i < 8; ++i) idle.push_back(std::make_unique<RawClient>(page_.port()));
  // Each has its thread once it has said something: connections are taken up in their order.
  EXPECT_EQ(Get("/"), "");

  idle.clear();
  std::string answer;
  for (int i = 0; i < 1000 && answer.empty(); ++i) answer = Get("/");
  EXPECT_THAT(answer, StartsWith("HTTP/1.1 200"));
}

TEST_F(LivePageTest, RefusesAPortThatIsTaken) {
  LivePageOptions options = Options();
  options.port = page_.port();
  Broadcast other;

  EXPECT_THROW(LivePage(options, {}, {}, &other), base::InputError);
}

TEST(LivePageOptions, RefusesWhatCannotBe) {
  const auto refuses = [](auto change) {
    LivePageOptions options;
    options.token = kToken;
    EXPECT_NO_THROW(options.Check());
    change(&options);
    EXPECT_THROW(options.Check(), base::InputError);
  };
  refuses([](LivePageOptions* options) { options->port = -1; });
  refuses([](LivePageOptions* options) { options->port = 65536; });
  refuses([](LivePageOptions* options) { options->token.clear(); });
  refuses([](LivePageOptions* options) { options->max_connections = 0; });
  refuses([](LivePageOptions* options) { options->max_readers = 0; });
  refuses([](LivePageOptions* options) { options->max_readers = options->max_connections + 1; });
}

TEST(LivePage, HasItsPortAgainAtOnce) {
  LivePageOptions options;
  options.token = kToken;
  for (int i = 0; i < 3; ++i) {
    Broadcast broadcast;
    const LivePage page(options, {{"/", {"text/html", "page"}}}, {}, &broadcast);
    options.port = page.port();
    EXPECT_THAT(
        Ask(page.port(), fmt::format("GET / HTTP/1.1\r\nHost: localhost:{}\r\n\r\n", page.port())),
        StartsWith("HTTP/1.1 200"));
  }
}

}  // namespace
}  // namespace softforce::serve

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <deque>
#include <opencv2/imgcodecs.hpp>

#include "vision/av_reader.h"
#include "vision/camera_stream.h"
#include "vision/jpeg_splitter.h"

extern "C" {
#include <libavutil/error.h>
}

namespace softforce::vision {
namespace {

int IsOver(void* patience) { return static_cast<Patience*>(patience)->over() ? 1 : 0; }

std::string ErrorText(int error) {
  std::array<char, AV_ERROR_MAX_STRING_SIZE> text{};
  return av_strerror(error, text.data(), text.size()) == 0 ? text.data() : "unknown error";
}

// A connection that delivers bytes.
class Connection {
 public:
  explicit Connection(AVIOContext* io) : io_(io) {}
  ~Connection() { avio_closep(&io_); }
  Connection(Connection&& other) noexcept
      : io_(std::exchange(other.io_, nullptr)), read_ahead_(std::move(other.read_ahead_)) {}
  Connection& operator=(Connection&&) = delete;

  // Waits for some bytes, at most `size`; <= 0 at the end or on an error.
  int Read(uint8_t* to, int size) {
    if (read_ahead_.empty()) return avio_read_partial(io_, to, size);
    const int count = std::min(size, static_cast<int>(read_ahead_.size()));
    std::copy_n(read_ahead_.begin(), count, to);
    read_ahead_.erase(read_ahead_.begin(), read_ahead_.begin() + count);
    return count;
  }

  // The first bytes, which stay to be read.
  const std::vector<uint8_t>& LookAhead(size_t wanted) {
    std::array<uint8_t, 4096> bytes;
    while (read_ahead_.size() < wanted) {
      const int count = avio_read_partial(io_, bytes.data(), static_cast<int>(bytes.size()));
      if (count <= 0) break;
      read_ahead_.insert(read_ahead_.end(), bytes.begin(), bytes.begin() + count);
    }
    return read_ahead_;
  }

 private:
  AVIOContext* io_;
  std::vector<uint8_t> read_ahead_;
};

// Motion JPEG, bare or multipart: the pictures carry no time.
class JpegStream : public CameraStream {
 public:
  JpegStream(Connection connection, Patience* patience)
      : connection_(std::move(connection)), patience_(patience) {}

  std::optional<Grabbed> Grab() override {
    std::array<uint8_t, 16384> bytes;
    while (true) {
      if (auto grabbed = Decode()) return grabbed;
      const int count = connection_.Read(bytes.data(), static_cast<int>(bytes.size()));
      if (count <= 0) {
        problem_ = patience_->over() ? "the stream gives no picture" : "the stream ended";
        return std::nullopt;
      }
      splitter_.Add(bytes.data(), static_cast<size_t>(count), [&](std::vector<uint8_t> jpeg) {
        waiting_.push_back({std::move(jpeg), MonotonicNow()});
      });
    }
  }

 private:
  struct Jpeg {
    std::vector<uint8_t> bytes;
    double arrival_s;
  };

  std::optional<Grabbed> Decode() {
    while (!waiting_.empty()) {
      const Jpeg jpeg = std::move(waiting_.front());
      waiting_.pop_front();
      Grabbed grabbed;
      grabbed.grey = cv::imdecode(jpeg.bytes, cv::IMREAD_GRAYSCALE | cv::IMREAD_IGNORE_ORIENTATION);
      grabbed.arrival_s = jpeg.arrival_s;
      if (!grabbed.grey.empty()) return grabbed;
    }
    return std::nullopt;
  }

  Connection connection_;
  Patience* patience_;
  JpegSplitter splitter_;
  std::deque<Jpeg> waiting_;
};

int ReadFrom(void* connection, uint8_t* to, int size) {
  const int count = static_cast<Connection*>(connection)->Read(to, size);
  return count == 0 ? AVERROR_EOF : count;
}

// Any other stream, by FFmpeg's demultiplexers and decoders.
class ContainerStream : public CameraStream {
 public:
  explicit ContainerStream(Patience* patience) : patience_(patience) {}
  ~ContainerStream() override {
    reader_.reset();  // before what it reads from
    if (io_ != nullptr) av_freep(&io_->buffer);
    avio_context_free(&io_);
  }

  // From a connection, or by FFmpeg's own means where there is none (RTSP).
  bool Open(const std::string& url, std::optional<Connection> connection) {
    AVFormatContext* container = avformat_alloc_context();
    container->interrupt_callback = {IsOver, patience_};
    if (connection) {
      constexpr int kBuffer = 16384;
      connection_.emplace(std::move(*connection));
      io_ = avio_alloc_context(static_cast<uint8_t*>(av_malloc(kBuffer)), kBuffer, 0, &*connection_,
                               ReadFrom, nullptr, nullptr);
      container->pb = io_;
    }
    container->flags |= AVFMT_FLAG_NOBUFFER;
    container->max_analyze_duration = AV_TIME_BASE;  // 1 s
    AVDictionary* options = nullptr;
    av_dict_set(&options, "rtsp_transport", "tcp", 0);
    const int error =
        avformat_open_input(&container, connection_ ? "" : url.c_str(), nullptr, &options);
    av_dict_free(&options);
    if (error < 0) {
      problem_ = ErrorText(error);
      return false;
    }
    reader_ = AvReader::Of(AvOwned<AVFormatContext>(container));
    if (reader_ == nullptr) problem_ = "there is no video in the stream";
    return reader_ != nullptr;
  }

  std::optional<Grabbed> Grab() override {
    auto picture = reader_->Next();
    if (!picture) {
      problem_ = patience_->over() ? "the stream gives no picture" : "the stream ended";
      return std::nullopt;
    }
    Grabbed grabbed;
    grabbed.grey = std::move(picture->grey);
    grabbed.arrival_s = MonotonicNow();
    grabbed.stream_s = picture->stream_s;
    return grabbed;
  }

 private:
  Patience* patience_;
  std::optional<Connection> connection_;
  AVIOContext* io_ = nullptr;
  std::unique_ptr<AvReader> reader_;
};

bool StartsWith(const std::string& text, const char* start) { return text.rfind(start, 0) == 0; }

// A JPEG, or a multipart message with one.
bool IsMotionJpeg(const std::vector<uint8_t>& bytes) {
  if (bytes.size() < 3) return false;
  const std::array<uint8_t, 3> start{0xFF, 0xD8, 0xFF};
  if (std::equal(start.begin(), start.end(), bytes.begin())) return true;
  const std::string text(bytes.begin(), bytes.end());
  return text.find("image/jpeg") != std::string::npos;
}

OpenedStream OpenContainer(const std::string& url, std::optional<Connection> connection,
                           Patience* patience, std::string* problem) {
  auto stream = std::make_unique<ContainerStream>(patience);
  if (stream->Open(url, std::move(connection))) return stream;
  *problem = stream->problem();
  return nullptr;
}

}  // namespace

OpenedStream OpenUrl(const LiveCamera& camera, Patience* patience, std::string* problem) {
  av_log_set_level(AV_LOG_FATAL);  // what goes wrong is reported by us
  const std::string& url = camera.source;
  const bool bytes = StartsWith(url, "tcp://") || StartsWith(url, "unix://");
  const bool http = StartsWith(url, "http://") || StartsWith(url, "https://");
  if (!bytes && !http) return OpenContainer(url, std::nullopt, patience, problem);

  const AVIOInterruptCB interrupt{IsOver, patience};
  AVIOContext* io = nullptr;
  const int error = avio_open2(&io, url.c_str(), AVIO_FLAG_READ, &interrupt, nullptr);
  if (error < 0) {
    *problem = ErrorText(error);
    return nullptr;
  }
  Connection connection(io);
  if (IsMotionJpeg(connection.LookAhead(256))) {
    return std::make_unique<JpegStream>(std::move(connection), patience);
  }
  // A server of HTTP takes a second connection, over which FFmpeg can do more.
  if (http) return OpenContainer(url, std::nullopt, patience, problem);
  return OpenContainer(url, std::move(connection), patience, problem);
}

}  // namespace softforce::vision

#include "vision/av_reader.h"

#include <set>

extern "C" {
#include <libavutil/pixdesc.h>
#include <libswscale/swscale.h>
}

namespace softforce::vision {
namespace {

struct FreeScaler {
  void operator()(SwsContext* p) const { sws_freeContext(p); }
};

// Formats without time stamps of their own: FFmpeg counts pictures and supposes a rate.
bool InventsTimes(const AVFormatContext& container) {
  static const std::set<std::string> kWithout{"mjpeg", "mpjpeg",   "h264",      "hevc",
                                              "m4v",   "rawvideo", "image2pipe"};
  return kWithout.count(container.iformat->name) > 0;
}

// Whether the first plane is the grey picture itself, with all its levels.
bool FirstPlaneIsGrey(const AVFrame& frame) {
  switch (frame.format) {
    case AV_PIX_FMT_GRAY8:
    case AV_PIX_FMT_YUVJ420P:
    case AV_PIX_FMT_YUVJ422P:
    case AV_PIX_FMT_YUVJ444P:
      return true;
    case AV_PIX_FMT_YUV420P:
    case AV_PIX_FMT_YUV422P:
    case AV_PIX_FMT_YUV444P:
      return frame.color_range == AVCOL_RANGE_JPEG;
    default:
      return false;
  }
}

}  // namespace

struct AvReader::State {
  AvOwned<AVFormatContext> container;
  AvOwned<AVCodecContext> codec;
  AvOwned<AVFrame> frame{av_frame_alloc()};
  AvOwned<AVPacket> packet{av_packet_alloc()};
  std::unique_ptr<SwsContext, FreeScaler> scaler;
  int stream = -1;
  bool times = false;  // whether the container has some
  bool flushed = false;

  cv::Mat Grey() {
    const int width = frame->width, height = frame->height;
    if (FirstPlaneIsGrey(*frame)) {
      return cv::Mat(height, width, CV_8UC1, frame->data[0],
                     static_cast<size_t>(frame->linesize[0]))
          .clone();
    }
    scaler.reset(sws_getCachedContext(scaler.release(), width, height,
                                      static_cast<AVPixelFormat>(frame->format), width, height,
                                      AV_PIX_FMT_GRAY8, SWS_POINT, nullptr, nullptr, nullptr));
    if (scaler == nullptr) return {};
    cv::Mat grey(height, width, CV_8UC1);
    const int stride = static_cast<int>(grey.step);
    sws_scale(scaler.get(), frame->data, frame->linesize, 0, height, &grey.data, &stride);
    return grey;
  }
};

AvReader::AvReader() : state_(new State) {}
AvReader::~AvReader() = default;

std::unique_ptr<AvReader> AvReader::Of(AvOwned<AVFormatContext> container) {
  if (container == nullptr || avformat_find_stream_info(container.get(), nullptr) < 0) return {};
  const AVCodec* decoder = nullptr;
  const int stream = av_find_best_stream(container.get(), AVMEDIA_TYPE_VIDEO, -1, -1, &decoder, 0);
  if (stream < 0 || decoder == nullptr) return {};
  std::unique_ptr<AvReader> reader(new AvReader);
  State& state = *reader->state_;
  state.codec.reset(avcodec_alloc_context3(decoder));
  avcodec_parameters_to_context(state.codec.get(), container->streams[stream]->codecpar);
  state.codec->thread_count = 1;  // threads of the decoder would hold pictures back
  state.codec->flags |= AV_CODEC_FLAG_LOW_DELAY;
  if (avcodec_open2(state.codec.get(), decoder, nullptr) < 0) return {};
  state.stream = stream;
  state.times = !InventsTimes(*container);
  state.container = std::move(container);
  return reader;
}

std::unique_ptr<AvReader> AvReader::OfFile(const std::string& file) {
  av_log_set_level(AV_LOG_FATAL);  // what goes wrong is reported by us
  AVFormatContext* opened = nullptr;
  if (avformat_open_input(&opened, file.c_str(), nullptr, nullptr) < 0) return {};
  return Of(AvOwned<AVFormatContext>(opened));
}

cv::Size AvReader::size() const { return {state_->codec->width, state_->codec->height}; }

std::optional<AvReader::Picture> AvReader::Receive() {
  AVFrame* frame = state_->frame.get();
  if (avcodec_receive_frame(state_->codec.get(), frame) < 0) return std::nullopt;
  Picture picture;
  picture.grey = state_->Grey();
  if (state_->times && frame->best_effort_timestamp != AV_NOPTS_VALUE) {
    const AVRational unit = state_->container->streams[state_->stream]->time_base;
    picture.stream_s = static_cast<double>(frame->best_effort_timestamp) * av_q2d(unit);
  }
  av_frame_unref(frame);
  if (picture.grey.empty()) return std::nullopt;
  return picture;
}

std::optional<AvReader::Picture> AvReader::Next() {
  while (true) {
    if (auto picture = Receive()) return picture;
    if (state_->flushed) return std::nullopt;
    AVPacket* packet = state_->packet.get();
    if (av_read_frame(state_->container.get(), packet) < 0) {
      state_->flushed = true;
      avcodec_send_packet(state_->codec.get(), nullptr);
      continue;
    }
    // A damaged packet is left out: the next one stands by itself, or starts a group again.
    if (packet->stream_index == state_->stream) {
      avcodec_send_packet(state_->codec.get(), packet);
    }
    av_packet_unref(packet);
  }
}

int CountPictures(const std::string& file) {
  av_log_set_level(AV_LOG_FATAL);
  AVFormatContext* opened = nullptr;
  if (avformat_open_input(&opened, file.c_str(), nullptr, nullptr) < 0) return 0;
  const AvOwned<AVFormatContext> container(opened);
  const AvOwned<AVPacket> packet(av_packet_alloc());
  int count = 0;
  while (av_read_frame(container.get(), packet.get()) >= 0) {
    if ((packet->flags & AV_PKT_FLAG_CORRUPT) == 0) ++count;
    av_packet_unref(packet.get());
  }
  return count;
}

}  // namespace softforce::vision

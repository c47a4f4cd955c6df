#include "vision/h264_encoder.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <string>

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/opt.h>
}

#include "softforce/base/input_error.h"

namespace softforce::vision {
namespace {

struct Free {
  void operator()(AVCodecContext* p) const { avcodec_free_context(&p); }
  void operator()(AVFrame* p) const { av_frame_free(&p); }
  void operator()(AVPacket* p) const { av_packet_free(&p); }
  void operator()(AVFormatContext* p) const {
    if (p->pb != nullptr) avio_closep(&p->pb);
    avformat_free_context(p);
  }
};

template <class T>
using Owned = std::unique_ptr<T, Free>;

}  // namespace

struct H264Encoder::State {
  std::filesystem::path file;
  Settings settings;
  Owned<AVFormatContext> container;
  Owned<AVCodecContext> codec;
  Owned<AVFrame> frame;
  Owned<AVPacket> packet;
  AVStream* stream = nullptr;  // the container's
  cv::Mat stacked;             // memory for the planes of a picture

  void Require(bool holds, const char* problem) const {
    if (holds) return;
    throw base::InputError(file.string(), std::string("the video cannot be written: ") + problem,
                           "Check the folder's permissions and the disk's space, or leave it out.");
  }

  void OpenCodec() {
    const AVCodec* encoder = avcodec_find_encoder(AV_CODEC_ID_H264);
    if (encoder == nullptr) encoder = avcodec_find_encoder(AV_CODEC_ID_MPEG4);
    Require(encoder != nullptr, "FFmpeg has neither an H.264 nor an MPEG-4 encoder");
    codec.reset(avcodec_alloc_context3(encoder));
    codec->width = settings.size.width;
    codec->height = settings.size.height;
    codec->time_base = av_inv_q(av_d2q(settings.frames_per_second, 1'000'000));
    codec->framerate = av_inv_q(codec->time_base);
    codec->pix_fmt = AV_PIX_FMT_YUV420P;
    // Grey pictures keep all 256 levels; colour is written as players expect it.
    codec->color_range = settings.grey ? AVCOL_RANGE_JPEG : AVCOL_RANGE_MPEG;
    codec->thread_count = 0;  // as many as help
    if ((container->oformat->flags & AVFMT_GLOBALHEADER) != 0) {
      codec->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
    }
    if (encoder->id == AV_CODEC_ID_MPEG4) {
      codec->flags |= AV_CODEC_FLAG_QSCALE;
      codec->global_quality = FF_QP2LAMBDA * std::clamp(settings.crf / 6, 1, 31);
    } else {
      av_opt_set_int(codec->priv_data, "crf", settings.crf, 0);
      if (settings.quick) {
        av_opt_set(codec->priv_data, "preset", "veryfast", 0);
        // Macroblock trees make bytes differ from run to run on processors with AVX-512; trellises
        // take a fifth of the time for a few per cent of the size.
        av_opt_set(codec->priv_data, "x264-params", "mbtree=0:trellis=0", 0);
      }
      if (settings.edges_first) {
        av_opt_set_int(codec->priv_data, "aq-mode", 0, 0);
        av_opt_set_int(codec->priv_data, "psy", 0, 0);
      }
    }
    Require(avcodec_open2(codec.get(), encoder, nullptr) >= 0, "the encoder does not open");
  }

  void Open() {
    av_log_set_level(AV_LOG_FATAL);  // what goes wrong is reported here
    AVFormatContext* made = nullptr;
    avformat_alloc_output_context2(&made, nullptr, "mp4", file.c_str());
    Require(made != nullptr, "FFmpeg cannot write MP4");
    container.reset(made);
    OpenCodec();
    stream = avformat_new_stream(container.get(), nullptr);
    Require(stream != nullptr, "out of memory");
    stream->time_base = codec->time_base;
    stream->avg_frame_rate = codec->framerate;
    avcodec_parameters_from_context(stream->codecpar, codec.get());
    Require(avio_open(&container->pb, file.c_str(), AVIO_FLAG_WRITE) >= 0,
            "the file cannot be opened");
    Require(avformat_write_header(container.get(), nullptr) >= 0, "its header cannot be written");
    frame.reset(av_frame_alloc());
    packet.reset(av_packet_alloc());
    frame->format = codec->pix_fmt;
    frame->width = codec->width;
    frame->height = codec->height;
    frame->color_range = codec->color_range;
    frame->pts = 0;
    Require(av_frame_get_buffer(frame.get(), 0) >= 0, "out of memory");
  }

  // The planes Y, U, V of a picture, stacked as OpenCV does.
  void Fill(const cv::Mat& picture) {
    Require(av_frame_make_writable(frame.get()) >= 0, "out of memory");
    const int width = codec->width, height = codec->height;
    cv::Mat planes[3];
    if (settings.grey) {
      planes[0] = picture;
      planes[1] = planes[2] = cv::Mat(height / 2, width / 2, CV_8U, cv::Scalar(128));
    } else {
      cv::cvtColor(picture, stacked, cv::COLOR_BGR2YUV_I420);
      uchar* chroma = stacked.data + static_cast<size_t>(width) * height;
      planes[0] = stacked.rowRange(0, height);
      planes[1] = cv::Mat(height / 2, width / 2, CV_8U, chroma);
      planes[2] = cv::Mat(height / 2, width / 2, CV_8U, chroma + width * height / 4);
    }
    for (int p = 0; p < 3; ++p) {
      cv::Mat target(planes[p].size(), CV_8U, frame->data[p],
                     static_cast<size_t>(frame->linesize[p]));
      planes[p].copyTo(target);
    }
  }

  // Hands a frame to the encoder (nothing: the end), and what it has finished to the file.
  void Encode(const AVFrame* next) {
    Require(avcodec_send_frame(codec.get(), next) >= 0, "the encoder refuses a picture");
    while (true) {
      const int received = avcodec_receive_packet(codec.get(), packet.get());
      if (received == AVERROR(EAGAIN) || received == AVERROR_EOF) return;
      Require(received >= 0, "the encoder fails");
      packet->duration = 1;
      av_packet_rescale_ts(packet.get(), codec->time_base, stream->time_base);
      packet->stream_index = stream->index;
      Require(av_interleaved_write_frame(container.get(), packet.get()) >= 0,
              "a picture cannot be stored");
    }
  }
};

H264Encoder::H264Encoder(const std::filesystem::path& file, const Settings& settings)
    : state_(new State{file, settings, {}, {}, {}, {}, nullptr, {}}) {
  state_->Open();
}
H264Encoder::~H264Encoder() = default;

void H264Encoder::Add(const cv::Mat& picture) {
  CV_Assert(picture.type() == (state_->settings.grey ? CV_8UC1 : CV_8UC3) &&
            picture.size() == state_->settings.size);
  state_->Fill(picture);
  state_->Encode(state_->frame.get());
  ++state_->frame->pts;
}

void H264Encoder::Finish() {
  state_->Encode(nullptr);
  state_->Require(av_write_trailer(state_->container.get()) >= 0, "its index cannot be stored");
  state_->Require(avio_closep(&state_->container->pb) >= 0, "it cannot be closed");
}

}  // namespace softforce::vision

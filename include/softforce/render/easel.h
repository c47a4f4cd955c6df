#pragma once

#include <memory>

namespace softforce::render {

// What drawing after drawing needs: memory for pixels, letters drawn before, the edges of a body's
// surface. With an easel of their own drawings are the same, but slower. For one drawing at a time.
class Easel {
 public:
  Easel();
  ~Easel();
  Easel(Easel&&) noexcept;
  Easel& operator=(Easel&&) noexcept;

  struct State;
  State& state() { return *state_; }

 private:
  std::unique_ptr<State> state_;
};

}  // namespace softforce::render

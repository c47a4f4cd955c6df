#include "softforce/render/easel.h"

#include "render/easel_state.h"

namespace softforce::render {

Easel::Easel() : state_(std::make_unique<State>()) {}
Easel::~Easel() = default;
Easel::Easel(Easel&&) noexcept = default;
Easel& Easel::operator=(Easel&&) noexcept = default;

}  // namespace softforce::render

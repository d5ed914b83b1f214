#include "vmech/hw_interface/variation/design_path.h"

namespace vmech {

void DesignPath::GoTo(const HeldDesign& to) noexcept {
  from_ = now_;
  to_ = to;
  share_ = 0;
  step_ = kFirst;
  stopped_ = false;
}

}  // namespace vmech

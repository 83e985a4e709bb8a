#include "sync/random/loss.h"

#include <stdexcept>
#include <string>

namespace tactus::sync {

Loss::Loss(const LossDef& def) : share_(def.share) {
  if (!(def.share >= 0 && def.share <= 1)) throw std::invalid_argument("a loss is a share from 0% to 100%");
  if (def.mean_burst == 0 || def.share == 1) {
    to_bad_ = stay_bad_ = def.share;
    return;
  }
  if (!(def.mean_burst >= 1)) throw std::invalid_argument("the mean burst of a loss is at least 1");
  stay_bad_ = 1 - 1 / def.mean_burst;
  to_bad_ = def.share / (def.mean_burst * (1 - def.share));
  if (to_bad_ > 1)
    throw std::invalid_argument("this share of losses in such short bursts is impossible: a burst must last " +
                                std::to_string(def.share / (1 - def.share)) + " or longer");
}

bool Loss::lose(double u) {
  // Starts in the stationary distribution of the states, so that the share holds from the first item.
  const double p = !started_ ? share_ : bad_ ? stay_bad_ : to_bad_;
  started_ = true;
  return bad_ = u < p;
}

}  // namespace tactus::sync

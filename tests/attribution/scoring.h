// Marks an answer against the sealed label.
#pragma once

#include <string>
#include <vector>

#include "examination.h"

namespace heatsoak::truth {

struct Share {
  int right = 0;
  int of = 0;
  void add(bool is_right) { right += is_right ? 1 : 0, ++of; }
};
/// "93.3 % (28/30; 95 %: 78.7 to 98.2)", Wilson's interval.
std::string in_words(const Share& share);

/// One of the names is the subject's or a name for the same heat.
bool names(const std::vector<std::string>& named, const Subject& subject);
/// The first name is right, and there is no other.
bool names_only(const std::vector<std::string>& named, const std::vector<const Subject*>& subjects);
/// The verdict is "unexplained", first a curve at the right node over one of the right drivers, and no effect of the catalogue.
bool names_outsider(const Answer& answer, const Outsider& outsider);
/// An effect of the catalogue, or a signal other than the clock that heat is said to follow.
bool gives_a_name(const Answer& answer);
/// The verdict is "unexplained", with heat at the stranger's node, and nothing gets a name.
bool leaves_unnamed(const Answer& answer, const Outsider& stranger);
/// The subject is named, or stands among the look-alikes of what is named.
bool mentions(const Answer& answer, const Subject& subject);
/// Neither an effect nor a curve.
bool is_silent(const Answer& answer);
/// "[iron_loss_eddy 41 nats or windage] …" and the first of the ladder and the scan.
std::string account(const Answer& answer);

}  // namespace heatsoak::truth

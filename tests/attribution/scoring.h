// Scores an answer against the hidden label.
#pragma once

#include <string>
#include <vector>

#include "examination.h"

namespace heatsoak::attribution::truth {

struct Share {
  int right = 0;
  int of = 0;
  void add(bool is_right) { right += is_right ? 1 : 0, ++of; }
};
/// Formats a share with Wilson's interval: "93.3 % (28/30; 95 %: 78.7 to 98.2)".
std::string in_words(const Share& share);

/// True if one of the names is the subject's name or another name for the same heat.
bool names(const std::vector<std::string>& named, const Subject& subject);
/// True if the first name is right and there is no other.
bool names_only(const std::vector<std::string>& named, const std::vector<const Subject*>& subjects);
/// True if the verdict is "unexplained" and the first curve is at the right node over one of the right signals. No catalogue effect may be
/// named.
bool names_outsider(const Answer& answer, const Outsider& outsider);
/// True if the answer names a catalogue effect or attributes heat to a signal other than the clock.
bool gives_a_name(const Answer& answer);
/// True if the verdict is "unexplained", with heat at the stranger's node and without any name.
bool leaves_unnamed(const Answer& answer, const Outsider& stranger);
/// True if the subject is named or listed as confounded with a named effect.
bool mentions(const Answer& answer, const Subject& subject);
/// True if the answer contains neither an effect nor a curve.
bool is_silent(const Answer& answer);
/// Summarises an answer for failure messages: "[iron_loss_eddy 41 nats or windage] …" and the best entries of the ladder and the scan.
std::string account(const Answer& answer);
/// Summarises verdict, effects, contradicted parameters and unexplained heat for failure messages.
std::string account(const diagnosis::Diagnosis& diagnosis);

}  // namespace heatsoak::attribution::truth

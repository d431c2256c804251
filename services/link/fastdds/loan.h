// A batch of samples on loan from a reader, returned when it goes out of scope.
#pragma once

#include "services/link/fastdds/fastdds_version.h"

namespace giveway::link {

template <typename Wire>
class Loan {
 public:
  using Samples = dds::LoanableSequence<Wire>;

  // Takes what the library gives in one go (32 samples by default); Size() 0 means nothing is left.
  explicit Loan(dds::DataReader& reader)
      : Loan(reader, [&](Samples& samples, dds::SampleInfoSeq& infos) {
          return reader.take(samples, infos);
        }) {}
  // What get(samples, infos), one of the reader's own functions, gives.
  template <typename Get>
  Loan(dds::DataReader& reader, Get&& get) : reader_(reader), code_(get(samples_, infos_)) {}
  ~Loan() {
    if (Ok(code_)) reader_.return_loan(samples_, infos_);
  }
  Loan(const Loan&) = delete;
  Loan& operator=(const Loan&) = delete;

  int Size() const { return Ok(code_) ? static_cast<int>(samples_.length()) : 0; }
  const Wire& Sample(int i) const { return samples_[i]; }
  const dds::SampleInfo& Info(int i) const { return infos_[i]; }
  const ReturnCode& Code() const { return code_; }

 private:
  dds::DataReader& reader_;
  Samples samples_;
  dds::SampleInfoSeq infos_;
  ReturnCode code_;
};

// Empties the reader: visit(sample, info) for every sample that carries data. The samples of one
// instance come in order of arrival; instances come one after the other.
template <typename Wire, typename Visit>
void TakeEach(dds::DataReader& reader, Visit&& visit) {
  while (true) {
    const Loan<Wire> loan(reader);
    if (loan.Size() == 0) return;
    for (int i = 0; i < loan.Size(); ++i) {
      if (loan.Info(i).valid_data) visit(loan.Sample(i), loan.Info(i));
    }
  }
}

}  // namespace giveway::link

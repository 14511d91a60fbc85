// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engine/scene/job.h"
#include "engine/scene/model.h"
#include "fuzz/choices.h"

namespace limn::fuzz {

// Verbs with options by choice, and what holds of their results. Options that have come later are
// chosen last, so that inputs which have been kept mean what they meant.

void Filter(engine::Model const& model, Choices& choices, engine::Job& job);
void MorphTo(engine::Model const& model, Choices& choices, engine::Job& job);
void SumBands(engine::Model const& model, Choices& choices, engine::Job& job);
void Combine(engine::Model const& model, Choices& choices, engine::Job& job);

void Smooth(engine::Model const& model, Choices& choices, engine::Job& job);

void Design(engine::Model const& model, Choices& choices, engine::Job& job);
void DrawLines(engine::Model const& model, Choices& choices, engine::Job& job);

}  // namespace limn::fuzz

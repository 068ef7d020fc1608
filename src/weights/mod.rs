//! Bounded biharmonic weights: how much each handle has to say at each vertex.

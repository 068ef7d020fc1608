//! The few points that govern a motion.

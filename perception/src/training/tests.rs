//! The network as a whole: learning, and the agreement of what was trained with what is shipped.

"""Parts of the evaluation: each module answers one question and adds its results to the Context."""

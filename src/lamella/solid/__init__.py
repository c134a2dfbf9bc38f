"""What is built as closed triangle meshes: strips with their slots and holes, bent and twisted, and the hardware."""
